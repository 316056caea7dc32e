// SPDX-License-Identifier: MIT
//
// A nightly store as one page without a network: a trend line for each method on each problem,
// the changes of level, the base. And the same changes as text.
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

struct StoreHistory {
  std::vector<Night> nights;          // without the seeds' errors
  std::vector<std::string> damaged;   // files that cannot be read: said, not counted
  std::vector<SeriesHistory> series;  // by problem, method, operator set
  std::vector<Blessing> blessings;
};

// Reads every night. Cost: the files' bytes once.
StoreHistory read_history(const NightStore& store);

std::string history_text(const StoreHistory& history);
// At most some hundred points a line: years stay below a megabyte or two.
std::string history_page(const StoreHistory& history);

}  // namespace tribench
