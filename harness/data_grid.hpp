// SPDX-License-Identifier: MIT
//
// A grid over a user's own files without a grid file: what `tribench run --data-file` asks for.
#pragma once

#include <string>
#include <vector>

#include "harness/grid.hpp"

namespace tribench {

struct DataGridRequest {
  std::vector<std::string> files;  // files, folders, patterns
  // What is said of each of them; its name and files are not looked at.
  user::UserProblem problem;
  std::string together;                      // a name: all files are one problem
  std::vector<std::string> test;             // files that test, in place of held-out rows
  std::vector<std::string> methods = {"*"};  // globs
  std::vector<std::string> operators = {"paper"};
};

// One problem a file, or one of them all. Throws Error (bad_input) with the option and the nearest
// name.
Grid make_data_grid(const DataGridRequest& request, const Registry& registry);

// For people, one sentence each: what reading the files of own problems came upon. Throws Error
// (bad_input) with the problem's place in the grid file where they cannot be read, or do not bear
// what is said of them.
std::vector<std::string> reading_notes(const Grid& grid);

}  // namespace tribench
