// SPDX-License-Identifier: MIT
#include "reports/run_reports.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "foundation/output_file.hpp"
#include "reports/comparison.hpp"
#include "reports/html/html_report.hpp"
#include "reports/html/page_data.hpp"
#include "reports/latex.hpp"
#include "reports/leaderboard.hpp"
#include "reports/markdown.hpp"
#include "reports/published.hpp"
#include "reports/run_folder.hpp"
#include "reports/suite_view.hpp"
#include "reports/summary.hpp"

namespace tribench {
namespace {

struct Change {
  std::string markdown;
  nlohmann::ordered_json json;  // null without a base
};

Change change_since(const std::filesystem::path& base, const RunFolder& run) {
  if (base.empty()) return {};
  const RunFolder before = read_run_folder(base);
  const Comparison comparison = compare_runs(before, run);
  const std::string since = fmt::format("Since {} ({}).\n\n", before.name,
                                        std::filesystem::canonical(base).filename().string());
  Change change{since + comparison_head(comparison), comparison_json(comparison)};
  change.json["base"] = before.name;
  change.json["base_started"] = before.provenance_of("sessions.0.started");
  change.json["started"] = run.provenance_of("sessions.0.started");
  return change;
}

}  // namespace

std::string run_tables_latex(const std::filesystem::path& folder) {
  RunFolder run = read_run_folder(folder);
  const auto figures = read_published(folder / kPublishedFile, run.complaints);
  const RunSummary summary = summarise(run);
  return latex_tables(run.name, summary, match_published(figures, summary));
}

std::string write_run_reports(const std::filesystem::path& folder,
                              const std::filesystem::path& base) {
  RunFolder run = read_run_folder(folder);
  const auto figures = read_published(folder / kPublishedFile, run.complaints);
  const RunSummary summary = summarise(run);
  const std::vector<PublishedProblem> published = match_published(figures, summary);
  const Change change = change_since(base, run);
  const std::vector<Sensitivity> sensitivity = ranking_sensitivity(run, summary);
  std::string text = leaderboard(run, summary, sensitivity, change.markdown);
  if (!published.empty()) {
    text += "\n## Published figures beside ours\n" + published_markdown(published, "###");
  }
  const std::vector<SuiteView> suites =
      view_suites(read_suites(folder / kSuiteFile, run.complaints), run.records);
  if (!suites.empty()) text += "\n## Suites\n" + suites_markdown(suites, "###");
  write_file(folder / "leaderboard.md", without_tags(text));
  nlohmann::ordered_json data = page_data(run, summary, published);
  data["changed"] = change.json;
  data["sensitivity"] = sensitivity_json(sensitivity);
  write_file(folder / "report.html", html_page(run.name, PageKind::run, data));
  return leaderboard_head(run, summary, change.markdown);
}

}  // namespace tribench
