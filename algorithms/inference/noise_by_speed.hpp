// SPDX-License-Identifier: MIT
//
// How wide the noise is at each speed: the logarithm of its level in groups of rows of like speed,
// straight between their middles. Internal to the room. Speeds in any unit, finite; not for noise
// that depends on the load or the place.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/student_law.hpp"

namespace tribench::loop {

class NoiseBySpeed {
 public:
  // speed: a magnitude a row, or empty: the noise is the same everywhere, as it is where there are
  // too few rows for groups. deviation: a row each, of the robust standard deviation robust_sd > 0.
  NoiseBySpeed(std::span<const double> speed, std::span<const double> deviation, double robust_sd);

  // Levels once more, from innovations in the present units, which follow the law.
  void refine(std::span<const double> innovation, const StudentLaw& law);

  // The noise at each row's speed.
  std::vector<double> units() const;

  // Of the logarithm of a speed's noise: its rows tell it, and the movements they are in, whose log
  // levels vary by `spread`.
  double variance(const StudentLaw& law, double spread, std::span<const RowRange> movements) const;

 private:
  std::span<const std::size_t> rows_of(std::size_t group) const;

  double robust_sd_;
  std::vector<double> speed_;  // per row; empty where it says nothing
  std::size_t rows_;
  std::vector<std::size_t> by_speed_;  // rows, slowest first
  std::vector<double> middle_speed_;   // per group
  std::vector<double> log_level_;      // ... of its noise over the robust sd
};

}  // namespace tribench::loop
