// SPDX-License-Identifier: MIT
//
// Completion of the command line in shells: subcommands, options, the values of options that are
// names (`tribench list` is asked for them, the one on PATH), files for all others.
#pragma once

#include <string>

#include "harness/cli/command_tree.hpp"

namespace tribench {

std::string bash_completion(const Command& program);

// The same function through zsh's bashcompinit.
std::string zsh_completion(const Command& program);

std::string fish_completion(const Command& program);

}  // namespace tribench
