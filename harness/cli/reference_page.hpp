// SPDX-License-Identifier: MIT
//
// The command line as the page docs/command_line.md: every subcommand with what its --help says.
#pragma once

#include <string>

#include "harness/cli/command_tree.hpp"

namespace tribench {

std::string reference_page(const Command& program);

}  // namespace tribench
