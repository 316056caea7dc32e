// SPDX-License-Identifier: MIT
//
// A percentile interval by drawing units (movements, or pieces of them) with replacement.
//
// Not for rows of one movement, which are not independent, nor for fewer than some ten units, whose
// percentiles say little. Cost: 2000 times the statistic.
//
// Source: Efron 1979.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {

// 95 % of what `statistic` makes of as many units as there are, drawn: it is called with the vector
// of their numbers, 2000 times. Deterministic given random. NaN of the statistic is not looked for.
template <typename Statistic>
std::pair<double, double> bootstrap_interval(std::size_t units, RandomStream random,
                                             const Statistic& statistic) {
  constexpr std::size_t kDraws = 2000;
  std::vector<double> values;
  std::vector<std::size_t> drawn(units);
  for (std::size_t b = 0; b < kDraws; ++b) {
    for (std::size_t& one : drawn) one = random.below(units);
    values.push_back(statistic(drawn));
  }
  std::ranges::sort(values);
  return {values[kDraws / 40], values[kDraws - 1 - kDraws / 40]};
}

}  // namespace tribench::loop
