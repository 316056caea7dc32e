// SPDX-License-Identifier: MIT
//
// Where a long series of nights changed its level: penalised change points, found exactly by
// optimal partitioning with pruning (PELT; Killick, Fearnhead, Eckley 2012), squared error weighted
// by how sure each night's value is. For a history; what a single night says is night_tests.hpp.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

struct LevelChange {
  std::size_t at = 0;  // the first value of the new level
  double before = 0;   // weighted means of the levels on either side
  double after = 0;
};

// values: finite. weights: positive, relative (1 / variance up to a factor); as many. The scale of
// the noise comes from the series itself: median absolute difference of neighbours, each in units
// of what its weights say, at least `least_noise` at the mean weight. A level lasts three values at
// least. Penalty 3 log n + 4 for a change: at independent normal noise about one series of a year
// in a thousand gets one. Beyond 1000 values levels begin at every second, third, ... place only
// before they are moved to where they fit best: a short one in ten years may be missed. Cost: O(n)
// to O(n^2) below that, half a millisecond.
std::vector<LevelChange> find_level_changes(std::span<const double> values,
                                            std::span<const double> weights,
                                            double least_noise = 1e-4);

}  // namespace tribench
