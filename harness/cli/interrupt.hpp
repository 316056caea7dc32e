// SPDX-License-Identifier: MIT
//
// Ctrl-C for commands that have something to close first. Internal to the command line.
#pragma once

#include <atomic>

namespace tribench {

// True once the user (SIGINT), the machine (SIGTERM) or the loss of the terminal (SIGHUP, unless
// nohup has it ignored) asked for an end; looked at by whoever can stop in good order. The same
// signal again ends the program at once.
const std::atomic<bool>& stop_requested_by_signal();

// True once the machine asked (SIGTERM): it ends this program itself half a minute or so later, so
// that nobody else's program may be waited for. Nothing but a flag; the above has to be called.
const std::atomic<bool>& end_requested_by_signal();

}  // namespace tribench
