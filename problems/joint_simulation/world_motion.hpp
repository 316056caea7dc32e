// SPDX-License-Identifier: MIT
//
// A planned movement as the simulated joint makes it: with ramps, and the other joint swinging.
#pragma once

#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"
#include "problems/joint_simulation/motion.hpp"

namespace tribench::simulation {

// From standstill to standstill with the limits' ramps; two tones start at full speed. Gravity is
// that of the limits under the movement's load.
Movement motion_for(const PlannedMovement& wanted, const MotionLimits& limits);

}  // namespace tribench::simulation
