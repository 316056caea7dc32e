// SPDX-License-Identifier: MIT
//
// Ctrl-C for commands that have something to close first. Internal to the command line.
#pragma once

#include <atomic>
#include <initializer_list>

namespace tribench {

// True once one of these signals has come; it is looked at by whoever can stop in good order. The
// same signal again ends the program at once.
const std::atomic<bool>& stop_requested_by(std::initializer_list<int> signals);

}  // namespace tribench
