// SPDX-License-Identifier: MIT
//
// What changed over a history of runs: a step (from one run on, the error is another) or a drift
// (it creeps). A comparison of two neighbours sees neither a slow drift nor, with noisy methods, a
// small step; a history does.
//
// Per method, operator set and problem: the series of log median errors. Step: largest
// standardised difference of means over all splits (Page 1957; Pettitt 1979 in spirit), drift:
// Kendall's tau against the order (Mann 1945), both with p by permutation of the order, so that
// nothing is assumed of the noise; Holm over all series. Where both are found, the one that leaves
// the smaller squared rest is reported.
#pragma once

#include <string>
#include <vector>

#include "reports/run_folder.hpp"

namespace tribench {

struct HistoryOptions {
  double level = 0.01;
  double equivalence = 0.01;        // smaller changes of the median error are not reported
  std::size_t permutations = 4999;  // p cannot be smaller than 1 / (permutations + 1)
};

struct Change {
  enum class Kind { step, drift };
  Kind kind = Kind::step;
  std::size_t at = 0;  // step: the first run after it
  double ratio = 1;    // error after / before the step; last / first along the drift
  double p = 1;        // before adjustment over series
};

// The change of one series, in log units, oldest first; p is 1 with fewer than 6 values or where
// nothing varies. key: of the permutations' stream.
Change find_change(const std::vector<double>& series, const HistoryOptions& options,
                   std::uint64_t key);

struct SeriesChange {
  std::string method;
  std::string operators;
  std::string problem;
  Change change;  // p Holm-adjusted
};

// Changes that pass the level, largest first. runs: oldest first; a series that a run lacks or
// where it failed is judged on the runs that have it.
std::vector<SeriesChange> find_changes(const std::vector<RunFolder>& runs,
                                       const HistoryOptions& options = {});

std::string history_markdown(const std::vector<SeriesChange>& changes,
                             const std::vector<RunFolder>& runs);

}  // namespace tribench
