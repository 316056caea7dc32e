// SPDX-License-Identifier: MIT
//
// tribench study loop: how often the closed loop is right, against its specification.
#pragma once

#include <CLI/App.hpp>

#include "harness/cli/commands.hpp"

namespace tribench {

void add_loop_study(CLI::App& study, ExitStatus& status);

}  // namespace tribench
