// SPDX-License-Identifier: MIT
//
// Has a method become worse since the base? Asked every night, for years: what one night cannot
// decide, three or seven together do, and the rate of false alarms is held over the year.
//
// For each method on each problem, and pooled over problems: the log errors of a window of nights
// (the last 1, 3, 7), averaged seed by seed, less those of the base; Wilcoxon's signed-rank test
// over seeds. Averaging takes out what differs from night to night; what base and nights have in
// common (the data of a seed) cancels.
//
// Alpha spending: each night spends alarms_a_year / nights_a_year, divided equally among windows
// and tests (Bonferroni). By the union bound, whatever depends on whatever, the expected number of
// false alarms in a year is at most alarms_a_year.
//
// A night's level is small: with fewer than about 18 seeds a single problem cannot reach it, and
// the pooled rows decide.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "reports/night.hpp"

namespace tribench {

struct NightTestOptions {
  double alarms_a_year = 1;
  double nights_a_year = 365.25;
  std::vector<std::size_t> windows = {1, 3, 7};
  double equivalence = 0.01;  // smaller losses are of no practical use
};

struct NightFinding {
  std::string method;
  std::string operators;
  std::string problem;  // empty: over all problems
  std::size_t window = 1;
  std::size_t pairs = 0;
  double ratio = 1;  // median of window / base
  double p = 1;      // to be held against `level`
  double level = 0;
};

// `since`: the nights after the base, oldest first; the last is the one in question. Nights of
// another grid or other data than the base's are left out; where the last is one of them nothing is
// found. Losses alone, the largest first. Cost: one exact test a series and window.
std::vector<NightFinding> find_losses(const Night& base, std::span<const Night> since,
                                      const NightTestOptions& options = {});

std::string losses_text(const std::vector<NightFinding>& findings);

}  // namespace tribench
