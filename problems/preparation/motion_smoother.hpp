// SPDX-License-Identifier: MIT
//
// Position, velocity and acceleration from a measured position: a Kalman filter for a motion whose
// jerk is white noise, run forwards and back (Rauch, Tung, Striebel 1965), so that nothing is
// delayed. Steps of time may be uneven. An encoder's staircase is taken for what it says: the
// position at the instants at which its count changes.
//
// The bandwidth is the one under which the measured positions are likeliest. Against a
// Savitzky-Golay filter and a smoothing spline on encoder data: docs/first_log.md.
//
// NaN policy: values and times are finite, times increase. Cost: about 0.5 us a row and trial.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

struct Motion {
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> acceleration;
  double bandwidth = 0;       // Hz
  double velocity_noise = 0;  // standard deviation that the position's noise leaves, typical row
  double acceleration_noise = 0;
};

// The smallest step between different values: an encoder's count; 0 where there is no such grid.
double resolution_of(std::span<const double> values);

// The staircase of an encoder drawn through the instants at which its count changes, and what is
// left of the error there as a share of the count's own (variance, per row).
struct Unstaired {
  std::vector<double> position;
  std::vector<double> variance;
};
Unstaired without_stairs(std::span<const double> time, std::span<const double> position,
                         double resolution);

// Pieces: [begin, end) ranges of rows without a gap, each smoothed by itself, all with one
// bandwidth (in Hz; 0: chosen from the data).
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
Motion smooth_motion(std::span<const double> time, std::span<const double> position,
                     std::span<const RowRange> pieces, double bandwidth = 0);

}  // namespace tribench
