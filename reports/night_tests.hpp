// SPDX-License-Identifier: MIT
//
// Has a method become worse since the base? Asked every night, for years: what one night cannot
// decide, three, seven or twenty together do, and the rate of false alarms is held over the year.
//
// Code that changes without harm still draws a search's errors anew, seed by seed; code that does
// not touch a method repeats them to the last digit. For each method on each problem and each seed
// the draws are therefore what differs from one night to the next, the base's first: a repeated
// figure is no second witness. Draws that came up in the last 1, 3, 7, 20 nights are held against
// all before them (of the base and the nights since), seed by seed, by a permutation test
// (statistics/permutation_shift.hpp): what a seed's data have in common cancels, the noise is known
// from the seed's own history, nothing is assumed of its distribution. The base's draw never leaves
// the sample: a creep is held against where it began.
//
// Alpha spending: each night spends alarms_a_year / nights_a_year, divided equally among windows
// and tests (Bonferroni). By the union bound, whatever depends on whatever, the expected number of
// false alarms in a year is at most alarms_a_year.
//
// With one draw before and one after, n seeds cannot give less than 2^-n: a first night with fewer
// than some 20 seeds cannot reach a night's level on one problem, and the rows over all problems
// decide.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "reports/comparison.hpp"
#include "reports/night.hpp"

namespace tribench {

struct NightTestOptions {
  double alarms_a_year = 1;
  double nights_a_year = 365.25;
  std::vector<std::size_t> windows = {1, 3, 7, 20};
  double equivalence = 0.005;  // smaller losses are of no practical use
};

// Nights before the last one that are worth reading: more would tell little more of the noise.
inline constexpr std::size_t kNightsLookedAt = 40;

struct NightFinding {
  std::string method;
  std::string operators;
  std::string problem;  // empty: over all problems
  std::size_t window = 1;
  std::size_t pairs = 0;  // seeds that have draws before and in the window
  double ratio = 1;       // median over seeds of mean after / mean before (of logs)
  double p = 1;           // to be held against `level`
  double level = 0;
};

// `since`: the nights after the base, oldest first; the last is the one in question. Nights of
// another grid or other data than the base's are left out; where the last is one of them nothing is
// found. Losses alone, the largest first. Cost: a few passes over the nights' errors a window.
std::vector<NightFinding> find_losses(const Night& base, std::span<const Night> since,
                                      const NightTestOptions& options = {});

// A night that has this many draws of a method on a problem before it can say more of a single odd
// figure than a comparison with the base alone.
inline constexpr std::size_t kNightsThatSettle = 5;

// Takes back what `comparison` (the base with the last of `since`) calls undecided, where the
// night's errors are within the tolerance of the mean of all draws before it: the base's own draw
// may have been a lucky one. Whether the level itself has moved is what find_losses asks.
void settle_by_nights(Comparison& comparison, const Night& base, std::span<const Night> since);

std::string losses_text(const std::vector<NightFinding>& findings);

}  // namespace tribench
