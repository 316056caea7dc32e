// SPDX-License-Identifier: MIT
#include "reports/loop_report.hpp"

#include <nlohmann/json.hpp>

#include "reports/record_csv.hpp"

namespace tribench {

void write_loop_report(const nlohmann::json& loop, const std::string& title,
                       const std::filesystem::path& folder) {
  write_file(folder / "loop.md", loop_markdown(loop, title));
}

}  // namespace tribench
