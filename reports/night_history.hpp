// SPDX-License-Identifier: MIT
//
// A nightly store as lines over the years: the error of each method on each problem, the
// instructions of each bench, and where a line changed its level. Drawn by night_page.hpp, told by
// night_feed.hpp.
#pragma once

#include <string>
#include <vector>

#include "reports/level_changes.hpp"
#include "reports/night_store.hpp"

namespace tribench {

struct SeriesHistory {
  std::string problem;
  std::string method;
  std::string operators;
  std::vector<std::size_t> nights;   // places among the store's nights
  std::vector<double> log_errors;    // log of the median error, one a night
  std::vector<LevelChange> changes;  // `at` counts in this series' own values
};

// A bench's case. Logs; a figure that a night lacks is NaN, a night without instructions is left
// out.
struct BenchHistory {
  std::string name;
  std::vector<std::size_t> nights;
  std::vector<double> instructions;
  std::vector<double> misses;        // of the last cache, one more than counted
  std::vector<double> time;          // in times of the reference kernel
  std::vector<LevelChange> changes;  // of the instructions
};

struct StoreHistory {
  std::vector<Night> nights;          // without the seeds' errors, series and benches
  std::vector<std::string> damaged;   // files that cannot be read: said, not counted
  std::vector<SeriesHistory> series;  // by problem, method, operator set
  std::vector<BenchHistory> benches;  // by name
  std::vector<Blessing> blessings;
};

// Reads every night. Cost: the files' bytes once.
StoreHistory read_history(const NightStore& store);

// A line's change of level.
struct HistoryChange {
  std::size_t night = 0;  // the first of the new level, among the store's nights
  std::string figure;     // "error", "instructions"
  std::string problem;    // or the bench's case
  std::string method;
  std::string operators;
  double ratio = 1;  // now / before
};

// The newest first, in one night the largest.
std::vector<HistoryChange> changes_of(const StoreHistory& history);

// How far a case's instructions differ between nights of one commit, whatever machine counted them:
// the widest of all cases. What equal code is said to differ by.
struct CountSpread {
  std::size_t cases = 0;   // cases (and commits) that were counted twice or more
  std::size_t nights = 0;  // the most nights of one commit
  double spread = 0;       // most / least - 1
  std::string name;        // of that case
};
CountSpread spread_of_counts(const StoreHistory& history);

// Nights, base and changes as Markdown.
std::string history_text(const StoreHistory& history);

}  // namespace tribench
