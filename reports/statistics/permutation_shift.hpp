// SPDX-License-Identifier: MIT
//
// Have the later draws become larger? A permutation test in strata, for tails far below what a
// simulation of permutations could reach.
//
// A stratum holds draws of one thing (a problem's error with one seed, run by one code after the
// other). Where nothing has changed its order means nothing: given the values, every choice of
// which of them came last is equally likely, stratum by stratum, whatever the distribution, however
// much the strata differ. The statistic is the sum over strata of (later scores - their mean). Its
// tail is bounded from above by Chernoff's bound, with the exact moment-generating function of
// sampling without replacement, and then estimated to a few percent by importance sampling from
// the draws tilted that far, at ties and corners of the distribution too.
//
// Scores may be any function of a stratum's values that forgets their order (and of other
// strata's). Sources: Pitman 1937 (permutation tests); Chernoff 1952; Siegmund 1976 (importance
// sampling by exponential tilting).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

struct ShiftStratum {
  std::vector<double> scores;  // finite; in the order of the draws
  std::size_t later = 0;       // how many of them, at the end, are asked about
};

// P(statistic >= the observed one) under equal likelihood of all orders, one-sided: small where
// later scores are larger. Where it is well above `largest_told` only the bound is given, or 1.
// Strata without a score on either side do not count. Deterministic. Cost: 30 times the sum over
// strata of scores x later, and where it is small 1000 times the number of scores.
double permutation_shift_p(std::span<const ShiftStratum> strata, double largest_told = 1);

}  // namespace tribench
