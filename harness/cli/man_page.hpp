// SPDX-License-Identifier: MIT
//
// The command line as a manual page (man(7) macros): every subcommand with what its --help says.
#pragma once

#include <string>
#include <string_view>

#include "harness/cli/command_tree.hpp"

namespace tribench {

// `version` stands at the page's foot.
std::string man_page(const Command& program, std::string_view version);

}  // namespace tribench
