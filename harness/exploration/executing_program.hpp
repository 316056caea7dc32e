// SPDX-License-Identifier: MIT
//
// A program that executes movements in the place of a simulated world: a robot's own.
//
// It is run once a movement, without a shell, with the path of a movements file (one line) as its
// last word, and prints the recording as CSV on its standard output: time, position, velocity and
// the friction torque (or the motor torque and, unless the limits have no gravity, the gravity
// torque), named and in units as in any file of data; rows in which a value is missing are left
// out. Exit status 2 with a reason on standard error
// refuses the movement; another one is chosen. Any other failure, or an answer that cannot be read,
// ends the exploration with an Error (failed), and so does `end` once it is true: the program is
// asked to end then (SIGTERM) and ended if it does not.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "algorithms/exploration/explorer.hpp"
#include "problems/experiment/motion_limits.hpp"

namespace tribench {

loop::ExecuteMovement executing_program(std::vector<std::string> command,
                                        const MotionLimits& limits, double limit_s,
                                        const std::atomic<bool>* end = nullptr);

// A clock that begins anew with each recording runs on from where the last one ended: a robot's
// program need not remember. The rows have a time and are not empty.
loop::ExecuteMovement with_running_clock(loop::ExecuteMovement execute);

}  // namespace tribench
