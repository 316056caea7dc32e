// SPDX-License-Identifier: MIT
//
// Whether the story that position, velocity, acceleration and time tell together is possible. Where
// one factor (degrees for radians, milliseconds for seconds, rpm, the gear ratio, a sign) explains
// why not, the recording is refused and the factor named; so it is where one column says nothing of
// how the other changes. Nothing is corrected silently.
#pragma once

#include <optional>
#include <span>

#include "problems/preparation/motion_smoother.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {

// Of a factor's logarithm: as near as that, a known factor explains it.
inline constexpr double kSameFactor = 0.08;

// How a quantity's change over some `window` (s; shorter in short pieces) goes with its rate's
// integral: 1 where both tell the same motion. `agreement` is their correlation; `change` and
// `integral` are their root mean squares.
struct MotionMatch {
  double slope = 1;
  double agreement = 0;
  double change = 0;
  double integral = 0;
};
MotionMatch match_motion(std::span<const double> time, std::span<const double> quantity,
                         std::span<const double> rate, std::span<const RowRange> pieces,
                         double window = 0.1);

// Throws Error (bad_input) where velocity and position disagree, or acceleration and velocity, or
// where a unit that was only assumed makes the motion absurd (a joint that turns many times over,
// steps of seconds).
void check_motion(const DataFile& file, std::optional<double> gear_ratio);

// What to say of a joint that turns over and over in a unit that the file itself names: it may be
// the motor. Nothing where --roles names the unit. After check_motion.
std::optional<std::string> remark_on_turns(const DataFile& file);

// By how much the velocity lags behind the position's own (s; negative: it leads); nothing where
// the rows do not tell. velocity_of_position: zero-phase.
std::optional<double> delay_of(std::span<const double> time,
                               std::span<const double> velocity_of_position,
                               std::span<const double> velocity, std::span<const RowRange> pieces);

}  // namespace tribench
