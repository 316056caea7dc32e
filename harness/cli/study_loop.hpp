// SPDX-License-Identifier: MIT
//
// tribench study loop: how often the closed loop is right, against its specification.
#pragma once

#include <CLI/App.hpp>

#include "harness/cli/commands.hpp"
#include "harness/study/loop_cases.hpp"

namespace tribench {

// --generator planted|simulated
void add_generator_option(CLI::App& command, LoopGenerator& generator);
void add_loop_study(CLI::App& study, ExitStatus& status);

}  // namespace tribench
