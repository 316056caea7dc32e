// SPDX-License-Identifier: MIT
//
// Does what a model leaves over repeat along a coordinate, in waves of whatever length? A score
// test of every wavenumber of a range at once, each with and without the direction of motion, the
// maximum over all of them held against sign flips of whole clusters: the family-wise error is kept
// however many wavenumbers are looked at.
//
// Not for waves of a known length (score_test.hpp), which cost no search, nor for coordinates that
// are not finite. What the model could do along a wave is not taken off the flipped sums: they come
// out too large, if anything, so that the test errs on the side of noise.
//
// Source: Lomb 1976, Scargle 1982 (periodogram of unevenly spaced rows); Hemerik, Goeman and Finos
// 2020 (flipped scores; the basic score is the conservative one).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "algorithms/inference/clusters.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// In radians of phase for one unit of the coordinate.
struct WaveRange {
  double low = 0;
  double high = 0;
  double step = 0;
};

// From `fewest` waves over the coordinate's span up to `shortest` in length, at most a thousand
// over the span. None where there is nothing in between. Rows need not follow one another closely:
// where they are not evenly spaced a wave is told from what is longer all the same.
std::optional<WaveRange> waves_over(std::span<const double> coordinate, double fewest,
                                    double shortest);

struct Wave {
  double wavenumber = 0;   // the most telling one of the range
  bool is_turned = false;  // it tells more times the direction
  double p = 1;            // adjusted for all that were looked at
};

// scores: per row, what a unit of a column at this row adds to its score; a model's residual
// through Whitening::adjoint. direction: -1, 0 or 1 a row; empty: none. Stops where p cannot come
// to alpha any more. Cost: rows x wavenumbers.
Wave strongest_wave(std::span<const double> coordinate, const Eigen::VectorXd& scores,
                    const Eigen::VectorXf& direction, const Clusters& clusters,
                    const WaveRange& range, std::size_t flips, double alpha, RandomStream random);

}  // namespace tribench::loop
