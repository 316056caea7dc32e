// SPDX-License-Identifier: MIT
#include "reports/run_reports.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/html/html_report.hpp"
#include "reports/html/page_data.hpp"
#include "reports/leaderboard.hpp"
#include "reports/published.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

std::string write_run_reports(const std::filesystem::path& folder) {
  RunFolder run = read_run_folder(folder);
  const auto figures = read_published(folder / "reference.csv", run.complaints);
  const RunSummary summary = summarise(run);
  const std::vector<PublishedRow> published = match_published(figures, summary);
  std::string text = leaderboard(run, summary);
  if (!published.empty()) {
    text += "\n## Published figures beside ours\n\n" + published_markdown(published);
  }
  write_file(folder / "leaderboard.md", text);
  write_file(folder / "report.html",
             html_page(run.name, PageKind::run, page_data(run, summary, published)));
  return leaderboard_head(run, summary);
}

}  // namespace tribench
