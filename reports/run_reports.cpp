// SPDX-License-Identifier: MIT
#include "reports/run_reports.hpp"

#include "reports/leaderboard.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

std::string write_run_reports(const std::filesystem::path& folder) {
  const RunFolder run = read_run_folder(folder);
  const RunSummary summary = summarise(run);
  write_file(folder / "leaderboard.md", leaderboard(run, summary));
  return leaderboard_head(run, summary);
}

}  // namespace tribench
