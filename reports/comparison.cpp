// SPDX-License-Identifier: MIT
#include "reports/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_conditions.hpp"
#include "reports/statistics/log_ratios.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

struct Pair {
  const Record* base;
  const Record* now;
};

// The record without what time and the machine touch: equal text, equal result.
std::string timeless(Record record) {
  forget_costs(record);
  return results_csv({record});
}

// Shorter fits have no pace: clocks, caches and the start of a process dominate.
constexpr double kLeastMeasuredCpu_s = 0.02;

double seconds_of(const Record& record) {
  return is_ok(record) && record.fit_cpu_s >= kLeastMeasuredCpu_s ? record.fit_cpu_s : kMissing;
}

// As few instructions as take that long are the same start of a process.
constexpr double kLeastInstructions = 2e7;

double instructions_of(const Record& record) {
  return is_ok(record) && record.fit_instructions >= kLeastInstructions ? record.fit_instructions
                                                                        : kMissing;
}

double evaluations_of(const Record& record) {
  return is_ok(record) && record.evaluations > 0 ? static_cast<double>(record.evaluations)
                                                 : kMissing;
}

using Figure = double (*)(const Record&);
using MethodKey = std::pair<std::string, std::string>;                 // method, operators
using Groups = std::map<MethodKey, std::map<std::string, LogRatios>>;  // by problem

// Of new over base; infinite where only one of them failed.
Groups log_ratios(const std::vector<Pair>& pairs, Figure figure) {
  Groups groups;
  for (const Pair& pair : pairs) {
    const double base = figure(*pair.base);
    const double now = figure(*pair.now);
    if (!LogRatios::is_pair(base, now)) continue;  // else there would be an empty group
    groups[{pair.now->method, pair.now->operators}][pair.now->problem].add(base, now);
  }
  return groups;
}

// What a test sees: of errors every draw once; a cost repeats because the work does.
enum class Tested { distinct, all };

std::vector<double> tested(const LogRatios& ratios, Tested what) {
  return what == Tested::distinct ? ratios.distinct() : ratios.all();
}

// Row with everything but the adjusted p and the verdict.
ComparisonRow row_of(const MethodKey& key, const std::string& problem,
                     const std::vector<const LogRatios*>& by_problem, Tested what,
                     const ComparisonOptions& options) {
  std::vector<double> all;
  std::vector<double> evidence;
  std::vector<std::vector<double>> groups;
  for (const LogRatios* ratios : by_problem) {
    groups.push_back(ratios->all());
    all.insert(all.end(), ratios->all().begin(), ratios->all().end());
    const std::vector<double> seen = tested(*ratios, what);
    evidence.insert(evidence.end(), seen.begin(), seen.end());
  }
  ComparisonRow row;
  row.method = key.first;
  row.operators = key.second;
  row.problem = problem;
  row.pairs = all.size();
  row.equal = static_cast<std::size_t>(std::count(all.begin(), all.end(), 0.0));
  row.ratio = elementary::exp(median(all));
  const SignedRankTest test = wilcoxon_signed_rank(evidence);
  row.p = test.p;
  row.effect = test.effect;
  if (row.equal == row.pairs) {
    row.interval = {1, 1};
    return row;
  }
  const RandomStream random(key_of(fmt::format("{}|{}|{}", key.first, key.second, problem)));
  const ConfidenceInterval logs = two_level_bootstrap(
      groups, [](std::span<const double> values) { return median(values); }, kConfidence,
      options.rounds, random);
  row.interval = {elementary::exp(logs.low), elementary::exp(logs.high)};
  return row;
}

std::vector<ComparisonRow> rows_of(const Groups& groups, bool each_problem, Tested what,
                                   const ComparisonOptions& options) {
  std::vector<ComparisonRow> rows;
  for (const auto& [key, problems] : groups) {
    std::vector<const LogRatios*> all;
    for (const auto& [problem, ratios] : problems) all.push_back(&ratios);
    rows.push_back(row_of(key, "", all, what, options));
  }
  if (!each_problem) return rows;
  for (const auto& [key, problems] : groups) {
    if (problems.size() < 2) continue;  // the pooled row says it all
    for (const auto& [problem, ratios] : problems) {
      rows.push_back(row_of(key, problem, {&ratios}, what, options));
    }
  }
  return rows;
}

ComparisonVerdict judge(const ComparisonRow& row, double level, double equivalence) {
  const double high = 1 + equivalence;
  const double low = 1 / high;
  if (row.p <= level && row.ratio > high) return ComparisonVerdict::worse;
  if (row.p <= level && row.ratio < low) return ComparisonVerdict::better;
  if (row.interval.low >= low && row.interval.high <= high) return ComparisonVerdict::equivalent;
  return ComparisonVerdict::not_distinguishable;
}

// Whether noise like `values` (centred) with the shift on it would be called worse.
bool is_seen(const std::vector<double>& values, double shift, double level, double equivalence) {
  std::vector<double> shifted = values;
  for (double& value : shifted) value += shift;
  return median(shifted) > elementary::log1p(equivalence) &&
         wilcoxon_signed_rank(shifted).p <= level;
}

// The least shift that is seen, by bisection; infinity where a loss of ten times is not.
double least_seen(const std::vector<double>& values, double level, double equivalence) {
  double low = 0;
  double high = elementary::log(10.0);
  if (!is_seen(values, high, level, equivalence)) return std::numeric_limits<double>::infinity();
  for (int step = 0; step < 10; ++step) {
    const double middle = 0.5 * (low + high);
    (is_seen(values, middle, level, equivalence) ? high : low) = middle;
  }
  return high;
}

// The loss that 8 of 10 resamples of these pairs, centred, would have shown. `level`: of one test.
double smallest_detectable_loss(std::vector<double> pairs, double level, std::uint64_t key,
                                const ComparisonOptions& options) {
  constexpr double kPower = 0.8;
  std::erase_if(pairs, [](double value) { return std::isinf(value); });
  if (pairs.empty()) return std::numeric_limits<double>::infinity();
  const double middle = median(pairs);
  for (double& value : pairs) value -= middle;
  std::vector<double> shifts;
  const RandomStream random(key);
  for (std::size_t round = 0; round < options.power_rounds; ++round) {
    RandomStream draws = random.split(round);
    std::vector<double> resample;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      resample.push_back(pairs[draws.below(pairs.size())]);
    shifts.push_back(least_seen(resample, level, options.quality_equivalence));
  }
  std::ranges::sort(shifts);
  return elementary::expm1(
      shifts[static_cast<std::size_t>(kPower * static_cast<double>(shifts.size()))]);
}

// Rows of one problem say what is undecided and what could have been seen; a pooled row only where
// it is the one row of its method.
void look_at_power(const Groups& groups, Comparison& comparison, const ComparisonOptions& options) {
  const double level =
      options.level / static_cast<double>(comparison.quality.size() + comparison.cost.size());
  for (ComparisonRow& row : comparison.quality) {
    const auto& problems = groups.at({row.method, row.operators});
    if (row.problem.empty() && problems.size() > 1) continue;
    row.undecided = row.ratio > 1 + options.tolerance && row.verdict != ComparisonVerdict::worse;
    if (options.power_rounds == 0) continue;
    const std::string& problem = row.problem.empty() ? problems.begin()->first : row.problem;
    row.detectable = smallest_detectable_loss(
        problems.at(problem).distinct(), level,
        key_of(fmt::format("power|{}|{}|{}", row.method, row.operators, problem)), options);
  }
}

// Holm over every row of the comparison, quality and cost together, that could say anything: given
// how much its pairs differ, a row whose pairs are all equal has no p but 1 and costs the others
// nothing (Tarone 1990).
void decide(Comparison& comparison, const ComparisonOptions& options) {
  std::vector<double> p;
  for (const auto* rows : {&comparison.quality, &comparison.cost}) {
    for (const ComparisonRow& row : *rows) p.push_back(row.equal < row.pairs ? row.p : kMissing);
  }
  const std::vector<double> adjusted = holm(p);
  std::size_t i = 0;
  const auto settle = [&](ComparisonRow& row, double equivalence) {
    const double own = adjusted[i++];
    row.p = std::isnan(own) ? 1 : own;
    row.verdict = judge(row, options.level, equivalence);
  };
  for (ComparisonRow& row : comparison.quality) settle(row, options.quality_equivalence);
  for (ComparisonRow& row : comparison.cost) settle(row, options.time_equivalence);
}

// CPU seconds of the calibration kernel in every session of a run.
std::vector<double> calibration_of(const RunFolder& run) {
  std::vector<double> seconds;
  for (const auto& [key, value] : run.provenance) {
    if (key.find(".calibration.samples.") == std::string::npos || !key.ends_with(".cpu_s")) {
      continue;
    }
    double figure = 0;
    if (read_csv_number(value, figure) && figure > 0) seconds.push_back(figure);
  }
  return seconds;
}

std::string why_no_seconds(const RunFolder& base, const RunFolder& now,
                           const ComparisonOptions& options) {
  for (const RunFolder* run : {&base, &now}) {
    const Spread spread = spread_of(calibration_of(*run));
    if (spread.count < 2) {
      return fmt::format("{} has no calibration", run->path.string());
    }
    const double drift = spread.high / spread.low - 1;
    if (drift > options.largest_drift) {
      return fmt::format("the machine's pace changed by {:.0f} % during {}", 100 * drift,
                         run->path.string());
    }
  }
  const std::string cpu = base.provenance_of("sessions.0.machine.cpu");
  if (cpu != now.provenance_of("sessions.0.machine.cpu")) return "the CPUs differ";
  return {};
}

// Whether fits of both runs had their instructions counted, but for the shortest.
bool has_instructions(const std::vector<Pair>& pairs) {
  return std::ranges::any_of(pairs, [](const Pair& pair) {
    return !std::isnan(instructions_of(*pair.base)) && !std::isnan(instructions_of(*pair.now));
  });
}

void compare_cost(const std::vector<Pair>& pairs, const RunFolder& base, const RunFolder& now,
                  const ComparisonOptions& options, Comparison& comparison) {
  Groups groups = log_ratios(pairs, seconds_of);
  comparison.why_no_seconds = why_no_seconds(base, now, options);
  if (comparison.why_no_seconds.empty() && groups.empty()) {
    comparison.why_no_seconds = fmt::format("no fit took {} s", kLeastMeasuredCpu_s);
  }
  if (!comparison.why_no_seconds.empty()) {
    const bool counted = has_instructions(pairs);
    comparison.cost_currency = counted ? CostCurrency::instructions : CostCurrency::evaluations;
    groups = log_ratios(pairs, counted ? instructions_of : evaluations_of);
    comparison.cost = rows_of(groups, false, Tested::all, options);
    return;
  }
  comparison.cost_currency = CostCurrency::cpu_seconds;
  // A machine that was slower throughout is no slower code.
  const double pace = elementary::log(median(calibration_of(now)) / median(calibration_of(base)));
  for (auto& [key, problems] : groups) {
    for (auto& [problem, ratios] : problems) ratios.shift(-pace);
  }
  comparison.cost = rows_of(groups, false, Tested::all, options);
}

// Two-sided exact sign test of `worse` against `better` cells.
double sign_test(std::size_t worse, std::size_t better) {
  const std::size_t n = worse + better;
  double tail = 0;
  for (std::size_t k = std::max(worse, better); k <= n; ++k) {
    const auto all = static_cast<double>(n);
    const auto hits = static_cast<double>(k);
    tail += elementary::exp(elementary::lgamma(all + 1) - elementary::lgamma(hits + 1) -
                            elementary::lgamma(all - hits + 1) - all * elementary::log(2.0));
  }
  return std::min(1.0, 2 * tail);
}

void count_failure(const Record& before, const Record& now, Comparison& comparison) {
  if (is_ok(before) && !is_ok(now)) {
    comparison.newly_failed.push_back(now.cell);
    if (!is_limit(now.reason.kind)) comparison.newly_broken.push_back(now.cell);
  }
  if (!is_ok(before) && is_ok(now)) comparison.newly_fine.push_back(now.cell);
}

void count_proof(const Record& before, const Record& now, Comparison& comparison) {
  const std::optional<Singularity> then = before.singularity;
  const std::optional<Singularity> after = now.singularity;
  if (after == Singularity::refuted && then != Singularity::refuted) {
    comparison.newly_singular.push_back(now.cell);
  }
  if (then == Singularity::refuted && is_ok(now) && after != Singularity::refuted) {
    comparison.no_longer_singular.push_back(now.cell);
  }
  if (then == Singularity::proved_free && after == Singularity::undecided) {
    comparison.newly_unproved.push_back(now.cell);
  }
  if (then == Singularity::undecided && after == Singularity::proved_free) {
    comparison.newly_proved.push_back(now.cell);
  }
}

void test_counts(Comparison& comparison) {
  comparison.singular_p =
      sign_test(comparison.newly_singular.size(), comparison.no_longer_singular.size());
  comparison.unproved_p =
      sign_test(comparison.newly_unproved.size(), comparison.newly_proved.size());
  comparison.limits_p = sign_test(comparison.newly_failed.size() - comparison.newly_broken.size(),
                                  comparison.newly_fine.size());
}

std::vector<Pair> count_cells(const RunFolder& base, const RunFolder& now, Comparison& comparison) {
  std::unordered_map<std::string_view, const Record*> by_cell;
  for (const Record& record : base.records) by_cell[record.cell] = &record;
  std::vector<Pair> pairs;
  for (const Record& record : now.records) {
    const auto found = by_cell.find(record.cell);
    if (found == by_cell.end()) {
      ++comparison.only_new;
      continue;
    }
    const Record& before = *found->second;
    pairs.push_back({&before, &record});
    if (timeless(before) == timeless(record)) ++comparison.identical;
    count_failure(before, record, comparison);
    count_proof(before, record, comparison);
  }
  test_counts(comparison);
  comparison.common = pairs.size();
  comparison.only_base = base.records.size() - pairs.size();
  return pairs;
}

std::size_t count_of(const std::vector<ComparisonRow>& rows, ComparisonVerdict verdict) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [&](const ComparisonRow& row) { return row.verdict == verdict; }));
}

}  // namespace

std::string_view cost_currency_name(CostCurrency currency) {
  switch (currency) {
    case CostCurrency::cpu_seconds:
      return "CPU seconds";
    case CostCurrency::instructions:
      return "instructions";
    case CostCurrency::evaluations:
      break;
  }
  return "evaluations";
}

std::string comparison_verdict_name(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::better:
      return "better";
    case ComparisonVerdict::worse:
      return "worse";
    case ComparisonVerdict::equivalent:
      return "equivalent";
    default:
      return "not distinguishable";
  }
}

const char* outcome_name(ComparisonOutcome outcome) {
  switch (outcome) {
    case ComparisonOutcome::regression:
      return "REGRESSION";
    case ComparisonOutcome::undecided:
      return "UNDECIDED";
    default:
      return "No regression";
  }
}

bool Comparison::has_regression() const {
  const bool more_limits =
      newly_failed.size() > newly_broken.size() + newly_fine.size() && limits_p <= level;
  const bool more_singular =
      newly_singular.size() > no_longer_singular.size() && singular_p <= level;
  return !newly_broken.empty() || more_limits || more_singular ||
         count_of(quality, ComparisonVerdict::worse) > 0 ||
         count_of(cost, ComparisonVerdict::worse) > 0;
}

std::vector<std::string> Comparison::doubts() const {
  std::vector<std::string> all;
  if (!conditions.empty() && !conditions_allowed) {
    all.push_back(
        fmt::format("the runs were asked different things ({} differences)", conditions.size()));
  }
  if (only_base > 0) all.push_back(fmt::format("{} cells of the base are missing", only_base));
  for (const ComparisonRow& row : quality) {
    if (!row.undecided) continue;
    all.push_back(fmt::format("{} ({}) on {}: {:.0f} % worse, not significant (p = {:.2g})",
                              row.method, row.operators, row.problem.empty() ? "all" : row.problem,
                              100 * (row.ratio - 1), row.p));
  }
  constexpr double kSuspicious = 0.05;
  if (newly_singular.size() > no_longer_singular.size() && singular_p <= kSuspicious &&
      singular_p > level) {
    all.push_back(fmt::format("{} formulas are newly singular, {} no longer", newly_singular.size(),
                              no_longer_singular.size()));
  }
  if (newly_unproved.size() > newly_proved.size() && unproved_p <= kSuspicious) {
    all.push_back(fmt::format("{} formulas are newly without a proof, {} have one again",
                              newly_unproved.size(), newly_proved.size()));
  }
  return all;
}

ComparisonOutcome Comparison::outcome() const {
  // What differs on purpose may well be worse: that decides nothing about the code.
  if (!conditions.empty() && !conditions_allowed) return ComparisonOutcome::undecided;
  if (has_regression()) return ComparisonOutcome::regression;
  return common == 0 || !doubts().empty() ? ComparisonOutcome::undecided : ComparisonOutcome::fine;
}

std::string Comparison::visibility() const {
  std::size_t asked = 0;
  std::vector<const ComparisonRow*> blind;
  for (const ComparisonRow& row : quality) {
    if (std::isnan(row.detectable)) continue;
    ++asked;
    if (row.detectable > tolerance) blind.push_back(&row);
  }
  if (asked == 0) return {};
  std::string text = fmt::format(
      "A loss of {:.0f} % or more would have been seen (8 times of 10) in {} of {} comparisons of "
      "a "
      "method on a problem",
      100 * tolerance, asked - blind.size(), asked);
  std::ranges::sort(blind, std::greater<>(), &ComparisonRow::detectable);
  constexpr std::size_t kShown = 5;
  for (std::size_t i = 0; i < std::min(kShown, blind.size()); ++i) {
    const ComparisonRow& row = *blind[i];
    text += fmt::format("{} {} ({}) on {} {}", i == 0 ? "; on" : ",", row.method, row.operators,
                        row.problem.empty() ? "all" : row.problem,
                        std::isinf(row.detectable)
                            ? std::string("none at all (too few pairs)")
                            : fmt::format("only one of {:.0f} %", 100 * row.detectable));
  }
  if (blind.size() > kShown) text += fmt::format(", and {} more", blind.size() - kShown);
  return text + ".";
}

std::string Comparison::sentence() const {
  if (common == 0) return "The runs have no cell in common: nothing can be compared.";
  if (common == identical && only_base + only_new == 0) {
    const std::size_t dearer = count_of(cost, ComparisonVerdict::worse);
    return fmt::format("All {} cells are identical apart from time{}.", common,
                       dearer > 0 ? fmt::format(", but {} methods cost more {}", dearer,
                                                cost_currency_name(cost_currency))
                                  : "");
  }
  return fmt::format(
      "{}: {} of {} common cells identical; quality worse in {}, better in {}, equivalent in {}, "
      "not distinguishable in {} of {} verdicts; dearer in {} of {} ({}); {} cells newly failed.",
      outcome_name(outcome()), identical, common, count_of(quality, ComparisonVerdict::worse),
      count_of(quality, ComparisonVerdict::better),
      count_of(quality, ComparisonVerdict::equivalent),
      count_of(quality, ComparisonVerdict::not_distinguishable), quality.size(),
      count_of(cost, ComparisonVerdict::worse), cost.size(), cost_currency_name(cost_currency),
      newly_failed.size());
}

Comparison compare_runs(const RunFolder& base, const RunFolder& now,
                        const ComparisonOptions& options) {
  Comparison comparison;
  comparison.level = options.level;
  comparison.tolerance = options.tolerance;
  comparison.conditions = condition_differences(base, now);
  comparison.conditions_allowed = options.allow_conditions;
  const std::vector<Pair> pairs = count_cells(base, now, comparison);
  const Groups quality = log_ratios(pairs, placing_error);
  comparison.quality = rows_of(quality, true, Tested::distinct, options);
  compare_cost(pairs, base, now, options, comparison);
  decide(comparison, options);
  look_at_power(quality, comparison, options);
  return comparison;
}

}  // namespace tribench
