// SPDX-License-Identifier: MIT
//
// tribench study memory.
#pragma once

#include <CLI/App.hpp>

namespace tribench {

class Registry;

void add_memory_study(CLI::App& study, const Registry& registry);

}  // namespace tribench
