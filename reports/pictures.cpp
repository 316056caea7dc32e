// SPDX-License-Identifier: MIT
#include "reports/pictures.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "reports/html/embedded.hpp"
#include "reports/html/page_data.hpp"
#include "reports/picture_files.hpp"
#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {
std::string picture_file(std::string_view problem, std::string_view operators,
                         std::string_view picture) {
  std::string name;
  bool replaced = false;  // a run of other characters becomes one _
  for (const char c : fmt::format("{}.{}.{}", problem, operators, picture)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("._+-").find(c) != std::string_view::npos;
    if (plain) name += c;
    if (!plain && !replaced) name += '_';
    replaced = !plain;
  }
  return name + ".svg";
}

std::vector<std::string> write_pictures(const std::filesystem::path& folder,
                                        const std::filesystem::path& out,
                                        const std::vector<std::string>& only) {
  const RunFolder run = read_run_folder(folder);
  const RunSummary summary = summarise(run);
  return draw_picture_files({embedded::run_plots_js(), embedded::pictures_js()},
                            page_data(run, summary, {}), out, only);
}

}  // namespace tribench
