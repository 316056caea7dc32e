// SPDX-License-Identifier: MIT
//
// The inside of a worker process: reads one task a line from standard input, answers with lines of
// JSON on standard output ({"started": record}, then {"finished": result} or {"out_of_memory":
// true}) and ends when the input ends or whoever started it dies. What a method prints goes to
// standard error, never into the answers.
#pragma once

#include "algorithms/registry.hpp"

namespace tribench {

// Answers tasks until there are no more. The process's exit status.
int run_worker(const Registry& registry);

}  // namespace tribench
