// SPDX-License-Identifier: MIT
//
// By how much a motor's torque or current comes later than the motion that it belongs to: through a
// filter, or a bus on which it is sent after the position. Left as it is, the gravity and the
// inertia that it is late with would pass for friction with the load, or with the acceleration, and
// a ripple of the gear would go with the speed.
//
// Told by the shift under which friction, inertia, gravity and, where the gear ratio is known, what
// repeats with the motor's turn explain most, on rows well away from
// rests and reversals: there friction that lags, as bristles do, goes with the motion's own terms.
// Friction that changes slowly through the recording, that builds up after a reversal, and what a
// smoother took off the acceleration have terms of their own: they passed for a delay, or hid one.
// NaN policy: values and times are finite, times increase within a piece. Cost: about 0.2 s.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/preparation/motion_smoother.hpp"

namespace tribench {

struct EffortDelay {
  double value = 0;  // s; negative: the torque comes first
  double error = 0;  // standard error, the recording's eighths left out in turn
};

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

}  // namespace tribench
