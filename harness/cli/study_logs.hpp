// SPDX-License-Identifier: MIT
//
// tribench study logs: is the same found in raw logs as in clean tables?
#pragma once

#include <CLI/App.hpp>

#include "harness/cli/commands.hpp"

namespace tribench {

void add_log_study(CLI::App& study, ExitStatus& status);

}  // namespace tribench
