// SPDX-License-Identifier: MIT
//
// By how much a motor's torque or current comes later than the motion that it belongs to: through a
// filter, or a bus on which it is sent after the position. Left as it is, the gravity and the
// inertia that it is late with would pass for friction with the load, or with the acceleration, a
// ripple of the gear would go with the speed, and friction's step at a reversal, smeared by a
// filter, would pass for friction that follows its velocity late.
//
// Told by the shift, or the first-order filter, of the motion under which friction, inertia,
// gravity and, where the gear ratio is known, what repeats with the motor's turn explain most of
// the same rows of the torque, well away from rests and reversals: there friction that lags, as
// bristles do, goes with the motion's own terms. Friction that falls with the speed, that changes
// slowly through the recording, that builds up after a reversal, and what a smoother took off the
// acceleration have terms of their own: they passed for a delay, or hid one. Not for more than 40
// ms, nor for filters of a higher order: one of the second order passes for one of the first that
// is as late. NaN policy: values and times are finite, times increase within a piece. Cost: some 15
// least squares of 30 terms on 20 000 rows at most, about 0.1 s; as much again where it is late,
// and a pass over all rows for each filter that is tried.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/preparation/motion_smoother.hpp"

namespace tribench {

struct EffortDelay {
  double value = 0;        // s; negative: the torque comes first
  double error = 0;        // standard error, the recording's eighths left out in turn
  bool is_filter = false;  // a first-order filter's time constant, not a bus's delay
};

// No filter and no bus brings a torque before its motion.
inline bool is_surely_late(const EffortDelay& delay) {
  constexpr double kSurely = 3;
  return delay.value > kSurely * delay.error;
}

// A step through a first-order filter is over but for a third of a thousandth after so many of the
// filter's delays.
inline constexpr double kFilterSettles = 8;

// Needs a time, an angle or a length, velocity, acceleration and motor_torque or motor_current;
// nothing where one of them is missing or where the rows do not tell.
// gear_ratio: motor turns per turn of the joint, where it is known; only for an angle. blunting:
// the acceleration less that of half the smoother's bandwidth, per row (see acceleration_blunting);
// empty where it was measured.
std::optional<EffortDelay> effort_delay(const Dataset& data, std::span<const RowRange> pieces,
                                        std::optional<double> gear_ratio = {},
                                        std::span<const double> blunting = {});

// A channel as it is `delay` later, by straight lines between neighbours of a piece; rows whose
// time lies outside of their piece then are marked in `lost`.
struct Shifted {
  std::vector<double> values;
  std::vector<char> lost;
};
Shifted shifted_by(std::span<const double> time, std::span<const double> values,
                   std::span<const RowRange> pieces, double delay);

// A channel through a first-order filter, straight between its rows, from each piece's begin on;
// rows that come before the filter has settled are marked in `lost`.
Shifted filtered_by(std::span<const double> time, std::span<const double> values,
                    std::span<const RowRange> pieces, double seconds);

}  // namespace tribench
