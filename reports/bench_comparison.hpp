// SPDX-License-Identifier: MIT
//
// Micro-benchmarks of a night against those of the base: what became dearer in a loop that a fit's
// seconds drown in noise.
//
// Instructions and cache misses are counted on a simulated machine: equal code counts equally on
// one kind of machine, so that half a percent more is a fact and no matter of chance. Time is
// paired with a reference kernel in the same process and still depends on what else the machine
// does: it raises a doubt, never an alarm.
#pragma once

#include <string>
#include <vector>

#include "reports/night.hpp"

namespace tribench {

struct BenchThresholds {
  double instructions = 0.005;  // larger losses are found; equal code counts equally
  double misses = 0.10;         // of either cache, where it is also ...
  double least_misses = 5000;   // ... so many more: below it an address makes the difference
  double time = 0.25;           // of the paired time, where it is also ...
  double time_spreads = 4;      // ... so many times what repetitions differ by
};

struct BenchChange {
  enum class Figure { instructions, first_level_misses, last_level_misses, time };
  Figure figure = Figure::instructions;
  std::string name;  // of the case
  double ratio = 1;  // now / base
};

struct BenchComparison {
  bool was_asked = false;           // both nights have benches
  bool is_first = false;            // this night has, the base has none
  std::string why_not_counted;      // other tool, level or library than the base's; empty: compared
  std::size_t cases = 0;            // in both
  std::vector<std::string> gone;    // cases of the base that are missing now
  std::vector<BenchChange> worse;   // instructions and misses; the largest first
  std::vector<BenchChange> slower;  // by the clock alone
  std::size_t better = 0;           // cases with fewer instructions, beyond the threshold

  // One line for a summary; empty where neither night has benches.
  std::string sentence() const;
};

// The changes, dearest first, as a table in Markdown; empty where there is none.
std::string bench_table(const BenchComparison& comparison);

BenchComparison compare_benches(const Night& base, const Night& now,
                                const BenchThresholds& thresholds = {});

}  // namespace tribench
