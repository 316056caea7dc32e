// SPDX-License-Identifier: MIT
//
// Records condensed to what people decide from: per problem and operator set one row a method,
// with how sure its place is; over all problems the mean ranks. Markdown, HTML and LaTeX print
// this and decide nothing themselves.
//
// How places are decided: by the median over seeds of the error on test movements; a cell that
// failed counts as worse than any formula. A method is held against the best of its table by
// Wilcoxon's signed-rank test on the log ratio of errors, paired by seed, Holm-adjusted within the
// table. Methods of a fixed form run once for all operator sets (under "-") and stand in every
// table.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "foundation/order_statistics.hpp"
#include "reports/record/record.hpp"
#include "reports/run_folder.hpp"
#include "reports/statistics/intervals.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {

inline constexpr double kLevel = 0.05;        // of every test
inline constexpr double kEquivalence = 0.01;  // a difference of 1 % is of no practical use

enum class Standing {
  best,                 // the smallest median of the table
  equivalent,           // within 1 % of the best
  not_distinguishable,  // the seeds disagree, or the test does
  behind_untested,      // behind on every seed, but too few seeds for a test
  behind,               // behind, and the test says so
  failed,               // no median: half of its cells or more failed
};

// A method's errors over a yardstick's, seed by seed; a failed cell counts as infinite.
struct YardstickRatio {
  double middle = kMissing;                            // median over the seeds
  ConfidenceInterval interval = {kMissing, kMissing};  // of it, 95 %; missing below six seeds
};

struct MethodRow {
  std::string method;
  std::string operators;  // "-" for a fixed form
  std::size_t cells = 0;  // records
  std::size_t failed = 0;
  std::size_t missing = 0;                     // planned, not there
  std::map<std::string, std::size_t> reasons;  // of failure, with counts
  Spread mae_test;                             // over the cells that gave a formula
  double placed_by = kMissing;                 // median with failed cells as infinite
  double mae_truth = kMissing;                 // medians over the cells that gave a formula
  double relative_error_test = kMissing;
  double complexity = kMissing;
  double complexity_adaptation = 0;
  double fit_cpu_s = kMissing;
  double evaluations = kMissing;
  YardstickRatio ceiling;   // the noise ceiling
  YardstickRatio refitted;  // the true law with its constants fitted to the same rows
  std::size_t proved_free = 0;
  std::size_t refuted = 0;
  std::size_t undecided = 0;
  // Cells whose formula was looked at: one that has a pole may fail on the test rows for that.
  std::size_t looked_at() const { return proved_free + refuted + undecided; }
  const Record* representative = nullptr;  // the cell whose error is nearest the median, below it
  const Record* singular = nullptr;        // the first cell with a witness

  Standing standing = Standing::behind;
  double ratio = kMissing;  // median over seeds of error / error of the best
  double p = kMissing;      // Holm-adjusted, against the best
  std::size_t pairs = 0;    // seeds that both have
  // The smallest factor between the errors that so many seeds would have shown in four of five
  // runs; infinite where they could show none. Only where a method is not distinguishable.
  double seen_ratio = kMissing;
};

struct ProblemTable {
  std::string problem;
  std::string operators;
  std::vector<MethodRow> rows;  // best first
  std::size_t seeds = 0;        // most that any method has
  // Yardsticks, where known; medians over the seeds.
  double mae_ceiling = kMissing;   // noise ceiling
  double mae_law = kMissing;       // the true law's own error
  double mae_refitted = kMissing;  // the same with its constants fitted to the training rows
  bool has_best() const { return !rows.empty() && rows.front().standing == Standing::best; }
};

// Mean ranks over problems for one operator set (Friedman, Nemenyi; blocks are problems, values
// the medians that place a method). Only methods that every problem has.
struct Ranking {
  std::string operators;
  std::vector<std::string> methods;   // best first
  FriedmanTest test;                  // mean_ranks in the order of `methods`
  std::vector<std::string> left_out;  // methods that some problem lacks
};

struct Failure {
  std::string method;
  std::string reason;
  std::vector<const Record*> cells;
};

// Points into the RunFolder's records: the folder must outlive it.
struct RunSummary {
  std::vector<std::string> problems;   // sorted
  std::vector<std::string> operators;  // sorted, without "-" unless it is the only one
  std::vector<ProblemTable> tables;    // by problem, then operator set
  std::vector<Ranking> rankings;       // one an operator set
  std::vector<Failure> failures;       // by count, most first
  std::size_t cells = 0;
  std::size_t failed = 0;
  double fit_cpu_s = 0;  // sum
};

RunSummary summarise(const RunFolder& run);

// The reading of one table, in words: who is best, who cannot be told from it, who failed.
std::string reading_of(const ProblemTable& table);
// One line on how sure the best's place is: "clearly", "ahead on all 2 seeds; untested", ...
std::string certainty_of(const ProblemTable& table);
std::string reading_of(const Ranking& ranking);
// "best", "within 1 %", "not distinguishable", "x1.84 (p 0.012)", ...
std::string standing_text(const MethodRow& row);
// "+7.2 % (-1.8 .. +10.1)", "x19 (18 .. 20)" from twice the yardstick on, "-" where not known.
std::string yardstick_ratio_text(const YardstickRatio& ratio);
// "Noise ceiling 0.04; the true law's error 0.04, 0.042 refitted."; empty where not known.
std::string yardsticks_text(const ProblemTable& table);

}  // namespace tribench
