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
  double bandwidth = 0;  // Hz
  // Root mean square over the rows away from the pieces' ends, as the filter knows it.
  double velocity_noise = 0;
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

// [begin, end): rows without a gap.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// The logarithm of how likely the positions are at these times, with the bandwidth that suits them
// best, up to a constant of the positions: of two tellings of the times the higher is the motion's.
double motion_likelihood(std::span<const double> time, std::span<const double> position,
                         std::span<const RowRange> pieces);

// Each piece is smoothed by itself, all with one bandwidth; where the jerk is large through the
// recording (ramps begin and end) is learned from it, as far as the likelihood rewards it.
class MotionSmoother {
 public:
  // `time` must outlive this.
  MotionSmoother(std::span<const double> time, std::span<const double> position,
                 std::span<const RowRange> pieces);
  // With `share` of the chosen bandwidth.
  Motion smoothed(double share = 1) const;

 private:
  std::span<const double> time_;
  std::vector<RowRange> pieces_;
  double step_;
  Unstaired positions_;
  std::vector<double> shape_;  // of the jerk's density, per row
  double bandwidth_ = 0;
};

}  // namespace tribench
