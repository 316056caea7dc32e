// SPDX-License-Identifier: MIT
//
// What a problem declares so that a formula can be judged by the motion that it predicts: the test
// movements row by row as they were recorded, and what the target leaves out of the joint's
// equation
//
//   inertia a + gravity(q) + formula = motor torque
//
// Where the target is itself the motor's torque (its role), the formula holds all of it and nothing
// is added; gravity then says what inputs with the role gravity_torque are at a simulated position.
//
// Channels have the names of the problem's inputs and the roles time, position and motor_torque
// (the drive: a torque, a force, or a voltage where the formula explains one).
#pragma once

#include <string>

#include "problems/dataset.hpp"

namespace tribench {

struct MotionTerms {
  double inertia = 0;    // 0: in the formula, which reads the acceleration
  std::string gravity;   // a formula in q, in the unit of the drive
  bool hold = false;     // the drive keeps a row's value until the next
  double horizon_s = 0;  // start again from the measured state every so many seconds; 0: never

  bool operator==(const MotionTerms&) const = default;
};

struct MotionCase {
  Dataset test;
  MotionTerms terms;
};

}  // namespace tribench
