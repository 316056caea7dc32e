// SPDX-License-Identifier: MIT
//
// tribench study smoothers.
#pragma once

#include <CLI/App.hpp>

namespace tribench {

void add_smoother_study(CLI::App& study);

}  // namespace tribench
