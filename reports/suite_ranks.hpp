// SPDX-License-Identifier: MIT
//
// Our methods among published results on the same tables, by R2 on unseen rows. Not for shares of
// laws recovered (suite_view.hpp).
//
// Each of ours is ranked among the published methods and itself alone, so that what else a run had
// changes nothing; the published ones among themselves. Rank 1 is the highest R2, equal ones share
// the better rank.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.hpp"

namespace tribench {

// A published figure.
struct SuiteResult {
  std::string problem;  // "srbench_blackbox/210_cloud"
  std::string method;
  bool symbolic = true;  // it gives a formula
  double r2 = 0;
  double seconds = 0;  // of a fit, theirs; NaN: not told
};

// One of ours on one table.
struct TableRank {
  std::string problem;
  std::string method;
  std::string operators;
  std::optional<double>
      r2;  // median over seeds, failed cells below all; none: that is a failed one
  std::size_t rank = 0;
  std::size_t symbolic_rank = 0;  // among those that give a formula
  double seconds = 0;             // median CPU seconds of a fit
};

struct RankedMethod {
  std::string method;
  std::string operators;  // empty: a published one
  bool symbolic = true;
  std::size_t tables = 0;
  double rank_median = 0;
  double rank_mean = 0;
  double symbolic_rank_median = kMissing;
  double seconds = kMissing;  // median over tables
};

struct SuiteRanks {
  std::vector<TableRank> tables;  // by table, then as the records come
  std::vector<SuiteResult> best;  // of each of these tables
  std::vector<SuiteResult> best_symbolic;
  // By median rank, ours and the published; empty unless every table has the same published
  // methods: ranks among different ones are not comparable.
  std::vector<RankedMethod> methods;
};

// Tables that the run has no record of, or nobody has published of, are left out.
SuiteRanks rank_among_published(const std::vector<SuiteResult>& published,
                                const std::vector<Record>& records);

std::string suite_ranks_markdown(const SuiteRanks& ranks);  // empty without tables
nlohmann::ordered_json suite_ranks_json(const SuiteRanks& ranks);

nlohmann::ordered_json suite_results_json(const std::vector<SuiteResult>& results);
// What suite_results_json wrote. Throws nlohmann::json::exception.
std::vector<SuiteResult> suite_results_in(const nlohmann::json& json);

}  // namespace tribench
