// SPDX-License-Identifier: MIT
//
// What the programs of a grid are, as far as files say it: two runs with two versions of one are
// two runs. Not what a program reads besides (modules, libraries, models): nobody can list that.
#pragma once

#include <map>
#include <string>

#include "harness/grid.hpp"

namespace tribench {

// "method: word of its command" and the SHA-256 of the file that the word names: the program, found
// in PATH where it has no slash, and every argument that is a file which can be read.
std::map<std::string, std::string> program_files(const Grid& grid);

}  // namespace tribench
