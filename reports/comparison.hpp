// SPDX-License-Identifier: MIT
//
// Is a run better or worse than another, or can they not be told apart? What a nightly job asks.
//
// In this order: what is exactly equal needs no statistics (equal cells with equal figures); cells
// that failed or turned singular are counted; quality is then compared on pairs with the same
// problem, method, operator set and seed: log ratio of the error on test movements, Wilcoxon's
// signed-rank test Holm-adjusted over all verdicts of the comparison, a bootstrap interval of the
// median ratio (two levels, problems and seeds, where problems are pooled). So is cost, pooled over
// problems: in CPU seconds where both machines' calibration says that they kept their pace, else in
// instructions where both runs have them counted, else in evaluations, which no machine changes and
// which see no slower code; the comparison says in what.
//
// What is asked first is whether the two are answers to one question: other budgets, parameters,
// seeds or data (run_conditions.hpp) leave the comparison undecided unless they are allowed.
//
// What a comparison cannot see it says: for each method on each problem the smallest loss that
// would have been found (in 8 of 10 repetitions of this night's noise, by resampling). A loss
// beyond the tolerance that is not significant is undecided, not fine.
//
// Verdicts: worse or better needs the adjusted p below the level AND a median ratio outside the
// region of practical equivalence; equivalent needs the whole interval inside that region;
// everything else is not distinguishable. Level 0.5 % for the whole comparison: of 200 comparisons
// of identical code about one cries (`tribench study compare`).
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/run_folder.hpp"
#include "reports/statistics/intervals.hpp"

namespace tribench {

enum class ComparisonVerdict { better, worse, equivalent, not_distinguishable };
std::string comparison_verdict_name(
    ComparisonVerdict verdict);  // "better", "not distinguishable", ...

// In what costs are compared: the first that both runs can be trusted in.
enum class CostCurrency { cpu_seconds, instructions, evaluations };
std::string_view cost_currency_name(CostCurrency currency);  // "CPU seconds", ...

struct ComparisonOptions {
  double level = 0.005;               // family-wise, over all verdicts, two-sided
  double quality_equivalence = 0.01;  // ratios within 1 +- this are of no practical use
  double time_equivalence = 0.05;
  double largest_drift = 0.05;    // of the calibration kernel within a run
  std::size_t rounds = 2000;      // of each bootstrap
  double tolerance = 0.05;        // a loss beyond this that is not significant is undecided
  std::size_t power_rounds = 50;  // resamples for the smallest detectable loss; 0: not asked
  bool allow_conditions = false;  // compare though budgets, parameters or data differ
};

// One method (operator set), on one problem or, with an empty problem, on all of them.
struct ComparisonRow {
  std::string method;
  std::string operators;
  std::string problem;
  std::size_t pairs = 0;        // seeds (and problems) that both runs have
  std::size_t equal = 0;        // pairs whose figure is the same to the last bit
  double ratio = kMissing;      // median of new / base
  ConfidenceInterval interval;  // of the ratio, at 95 %
  double effect = 0;            // rank-biserial; positive where new is larger (worse)
  double p = kMissing;          // Holm-adjusted
  ComparisonVerdict verdict = ComparisonVerdict::not_distinguishable;
  // The smallest loss (0.08: 8 %) that would have been a worse verdict; infinity where none would.
  double detectable = kMissing;
  bool undecided = false;  // a loss beyond the tolerance that is not significant
};

enum class ComparisonOutcome { fine, regression, undecided };
const char* outcome_name(ComparisonOutcome outcome);  // "No regression", "REGRESSION", "UNDECIDED"

struct Comparison {
  std::size_t common = 0;     // cells in both
  std::size_t identical = 0;  // of them, equal in everything but time
  std::size_t only_base = 0;
  std::size_t only_new = 0;
  std::vector<std::string> newly_failed;    // cells that gave a formula before
  std::vector<std::string> newly_broken;    // of them, not by running into a limit
  std::vector<std::string> newly_fine;      // cells that failed before
  std::vector<std::string> newly_singular;  // refuted now, not before
  std::vector<std::string> no_longer_singular;
  std::vector<std::string> newly_unproved;  // proved free before, undecided now
  std::vector<std::string> newly_proved;    // the other way round
  double singular_p = 1;                // of newly and no longer singular ones (exact sign test)
  double unproved_p = 1;                // of the two counts of proofs
  std::vector<std::string> conditions;  // in what the two runs were asked differently
  bool conditions_allowed = false;
  double tolerance = 0.05;
  std::vector<ComparisonRow> quality;  // pooled rows first, then by problem
  std::vector<ComparisonRow> cost;     // pooled rows only
  CostCurrency cost_currency = CostCurrency::cpu_seconds;
  std::string why_no_seconds;  // empty where the currency is CPU seconds
  // Cells that newly ran into a limit against those that no longer do (exact sign test).
  double limits_p = 1;
  double level = 0.005;

  // A worse verdict, a cell that newly crashed or gave an error, or clearly more cells that ran
  // into a limit (a single one may be the machine's bad moment).
  bool has_regression() const;
  // Something of which this comparison cannot say that it is fine: differing conditions, cells that
  // are missing, a loss beyond the tolerance that is not significant, more singular formulas.
  std::vector<std::string> doubts() const;
  ComparisonOutcome outcome() const;
  // What would have been seen, and where not.
  std::string visibility() const;
  std::string sentence() const;  // the outcome in one line
};

Comparison compare_runs(const RunFolder& base, const RunFolder& now,
                        const ComparisonOptions& options = {});

std::string comparison_markdown(const Comparison& comparison);
// What fits on a first screen: the outcome, the cells that changed, pooled rows and verdicts.
std::string comparison_head(const Comparison& comparison);
nlohmann::ordered_json comparison_json(const Comparison& comparison);

}  // namespace tribench
