// SPDX-License-Identifier: MIT
//
// Whether a recording can be the movement that was asked for: a program that prints degrees, the
// motor's side, another joint or the same rows again would be believed, and its units become
// effects.
#pragma once

#include <string>

#include "problems/dataset.hpp"
#include "problems/experiment/motion_limits.hpp"

namespace tribench {

// What does not fit, and the mend; empty where everything does.
struct Misfit {
  std::string what;
  std::string mend;
  bool is_one() const { return !what.empty(); }
};

// The position stays within the limits, widened by a fifth of their range; and where the recording
// lasts a second, it covers a quarter of the way that was asked for, and the velocity is its rate,
// within a factor of 2.5; the torque, the motor's where it is there, is not more than so many times
// the limit. The way to the start may be in the recording. rows: at least one, with
// time, position and velocity in SI units.
Misfit misfit_of(const Dataset& rows, const PlannedMovement& asked, const MotionLimits& limits);

}  // namespace tribench
