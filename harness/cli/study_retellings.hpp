// SPDX-License-Identifier: MIT
//
// tribench study retellings: does the loop say the same of a recording however it is told?
#pragma once

#include <CLI/App.hpp>

#include "harness/cli/commands.hpp"

namespace tribench {

void add_retelling_study(CLI::App& study, ExitStatus& status);

}  // namespace tribench
