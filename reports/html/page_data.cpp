// SPDX-License-Identifier: MIT
#include "reports/html/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "foundation/json_text.hpp"
#include "reports/figures.hpp"
#include "reports/html/page_series.hpp"
#include "reports/record/record_json.hpp"
#include "reports/suite_view.hpp"

namespace tribench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kRecords = 3000;
constexpr std::size_t kSingular = 2000;
constexpr std::size_t kMissingShown = 100;
constexpr std::size_t kCellsOfFailure = 5;

const char* standing_name(Standing standing) {
  switch (standing) {
    case Standing::best:
      return "best";
    case Standing::equivalent:
      return "equivalent";
    case Standing::not_distinguishable:
      return "not_distinguishable";
    case Standing::behind_untested:
      return "behind_untested";
    case Standing::behind:
      return "behind";
    default:
      return "failed";
  }
}

ordered_json row_json(const MethodRow& row) {
  const Record* shown = row.representative;
  return {{"method", row.method},
          {"mae", finite_or_null(row.mae_test.middle)},
          {"low", finite_or_null(row.mae_test.low)},
          {"high", finite_or_null(row.mae_test.high)},
          {"ratio",
           row.standing == Standing::failed ? ordered_json(nullptr) : finite_or_null(row.ratio)},
          {"p", finite_or_null(row.p)},
          {"seen_ratio", finite_or_null(row.seen_ratio)},
          {"standing", standing_name(row.standing)},
          {"standing_text", standing_text(row)},
          {"truth", finite_or_null(row.mae_truth)},
          {"relative", finite_or_null(row.relative_error_test)},
          {"complexity", finite_or_null(row.complexity)},
          {"cpu", finite_or_null(row.fit_cpu_s)},
          {"proved", row.proved_free},
          {"refuted", row.refuted},
          {"looked_at", row.looked_at()},
          {"failed", row.failed},
          {"cells", row.cells},
          {"seed", shown == nullptr ? ordered_json(nullptr) : ordered_json(shown->seed)},
          {"formula", shown == nullptr ? std::string() : shown->formula}};
}

ordered_json tables_json(const RunSummary& summary) {
  ordered_json all = ordered_json::array();
  for (const ProblemTable& table : summary.tables) {
    ordered_json rows = ordered_json::array();
    for (const MethodRow& row : table.rows) rows.push_back(row_json(row));
    all.push_back({{"problem", table.problem},
                   {"operators", table.operators},
                   {"reading", reading_of(table)},
                   {"certainty", certainty_of(table)},
                   {"ceiling", finite_or_null(table.mae_ceiling)},
                   {"yardsticks", yardsticks_text(table)},
                   {"rows", std::move(rows)}});
  }
  return all;
}

ordered_json rankings_json(const RunSummary& summary) {
  ordered_json all = ordered_json::array();
  for (const Ranking& ranking : summary.rankings) {
    all.push_back({{"operators", ranking.operators},
                   {"methods", ranking.methods},
                   {"ranks", ranking.test.mean_ranks},
                   {"critical_difference", finite_or_null(ranking.test.critical_difference)},
                   {"p", finite_or_null(ranking.test.p)},
                   {"reading", reading_of(ranking)}});
  }
  return all;
}

// The witness's coordinates; of two neighbouring points the first.
ordered_json witness_point(const std::string& witness) {
  ordered_json point = read_json<ordered_json>(witness);
  if (point.is_object() && point.contains("between") && point["between"].is_array() &&
      !point["between"].empty()) {
    point = ordered_json(point["between"][0]);
  }
  return point.is_object() ? point : ordered_json(nullptr);
}

ordered_json singular_json(const RunFolder& run) {
  ordered_json all = ordered_json::array();
  for (const Record& record : run.records) {
    if (record.singularity != Singularity::refuted || all.size() >= kSingular) continue;
    ordered_json point = witness_point(record.witness);
    if (point.is_null()) continue;
    all.push_back({{"problem", record.problem},
                   {"method", record.method},
                   {"operators", record.operators},
                   {"seed", record.seed},
                   {"point", std::move(point)},
                   {"formula", record.formula}});
  }
  return all;
}

ordered_json failures_json(const RunSummary& summary) {
  ordered_json all = ordered_json::array();
  for (const Failure& failure : summary.failures) {
    ordered_json cells = ordered_json::array();
    for (const Record* cell : failure.cells) {
      if (cells.size() < kCellsOfFailure) cells.push_back(cell->cell);
    }
    all.push_back({{"method", failure.method},
                   {"reason", failure.reason},
                   {"count", failure.cells.size()},
                   {"cells", std::move(cells)}});
  }
  return all;
}

// Failed and singular records first, then those that stand for their method, then the rest, until
// the page is full.
std::vector<const Record*> chosen_records(const RunFolder& run, const RunSummary& summary) {
  std::vector<const Record*> chosen;
  std::unordered_set<const Record*> taken;
  const auto take = [&](const Record* record) {
    if (record != nullptr && chosen.size() < kRecords && taken.insert(record).second) {
      chosen.push_back(record);
    }
  };
  if (run.records.size() > kRecords) {
    std::size_t special = 0;
    for (const Record& record : run.records) {
      const bool is_special = !is_ok(record) || record.singularity == Singularity::refuted;
      if (is_special && ++special <= kRecords / 2) take(&record);
    }
    for (const ProblemTable& table : summary.tables) {
      for (const MethodRow& row : table.rows) take(row.representative);
    }
  }
  for (const Record& record : run.records) take(&record);
  return chosen;
}

ordered_json records_json(const RunFolder& run, const RunSummary& summary) {
  const std::vector<std::string> columns = {"problem",     "method",     "operators",   "seed",
                                            "status",      "reason",     "mae_train",   "mae_test",
                                            "r2_test",     "complexity", "evaluations", "fit_cpu_s",
                                            "singularity", "witness",    "formula",     "note"};
  ordered_json rows = ordered_json::array();
  for (const Record* r : chosen_records(run, summary)) {
    rows.push_back(record_row(*r, columns));
  }
  return {{"columns", columns}, {"total", run.records.size()}, {"rows", std::move(rows)}};
}

ordered_json counts_json(const RunFolder& run, const RunSummary& summary) {
  return {{"cells", summary.cells},
          {"failed", summary.failed},
          {"missing", run.missing.size()},
          {"planned", run.planned},
          {"cpu", duration_figure(summary.fit_cpu_s)}};
}

ordered_json suites_of(const RunFolder& run) {
  std::vector<std::string> said_in_the_text;
  return suite_views_json(
      view_suites(read_suites(run.path / kSuiteFile, said_in_the_text), run.records));
}

}  // namespace

ordered_json page_data(const RunFolder& run, const RunSummary& summary,
                       const std::vector<PublishedProblem>& published) {
  ordered_json missing = ordered_json::array();
  for (std::size_t i = 0; i < std::min(kMissingShown, run.missing.size()); ++i) {
    missing.push_back(run.missing[i].cell);
  }
  ordered_json provenance = ordered_json::array();
  for (const auto& [key, value] : run.provenance) provenance.push_back({key, value});
  ordered_json ecdf;
  ordered_json traces = traces_json(run, summary, ecdf);
  const std::string commit = run.provenance_of("code.commit");
  return {{"name", run.name},
          {"made_with", fmt::format("tribench {}{}{}", run.provenance_of("code.version"),
                                    commit.empty() ? "" : ", commit ", commit)},
          {"counts", counts_json(run, summary)},
          {"problems", summary.problems},
          {"operators", summary.operators},
          {"tables", tables_json(summary)},
          {"rankings", rankings_json(summary)},
          {"fronts", fronts_json(run)},
          {"traces", std::move(traces)},
          {"profiles", profiles_json(run, summary)},
          {"ecdf", std::move(ecdf)},
          {"curves", curves_json(run)},
          {"singular", singular_json(run)},
          {"failures", failures_json(summary)},
          {"missing", std::move(missing)},
          {"complaints", run.complaints},
          {"reference", published_json(published)},
          {"suites", suites_of(run)},
          {"records", records_json(run, summary)},
          {"provenance", std::move(provenance)}};
}

}  // namespace tribench
