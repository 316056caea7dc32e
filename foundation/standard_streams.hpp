// SPDX-License-Identifier: MIT
//
// The three streams that a process is started with, whatever was done to them: closed, a full disk,
// a reader that went away. What cannot be written to the output is an error; what cannot be said on
// standard error is not worth dying for.
//
// Not for the streams of child processes (child_process.hpp).
#pragma once

#include <string_view>

namespace tribench {

// To be called first in main. Streams that are closed are opened, so that no file of ours takes
// their number: reading ends at once, output fails, messages vanish. A full disk and a limit on
// file sizes become errors of write(), not reasons to die.
void take_standard_streams();

// Says something to the user on standard error. Never throws; safe from several threads.
void print_message(std::string_view text);

// Whether all that was printed to the standard output has arrived there; flushes it.
bool has_output_arrived();

}  // namespace tribench
