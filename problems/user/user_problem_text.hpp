// SPDX-License-Identifier: MIT
//
// User problems as TOML, [[problem]] of a grid, in and out: what a grid file says, what a run's
// folder keeps and what a worker process is told are the same text. Keys: docs/grid.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/toml_table.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench::user {

// [[problem]] of a file; paths count from `folder`. A table without a name is a problem a file.
// Files are hashed here, unless the text says what they must hash to.
// Throws Error (bad_input) with file, line and the nearest key or name.
std::vector<UserProblem> read_user_problems(const TomlTable& file,
                                            const std::filesystem::path& folder);
// Of a whole text with such tables and others beside them.
std::vector<UserProblem> parse_user_problems(std::string_view toml, const std::string& file_name,
                                             const std::filesystem::path& folder);

// How the text names files.
enum class FileNames {
  as_held,      // from the working directory
  from_folder,  // from the folder in which the text will lie
  bare,         // without their folders: the same on every machine
};
toml::array user_problems_array(std::span<const UserProblem> own, FileNames names,
                                const std::filesystem::path& folder = {});
// One problem as a text that parse_user_problems reads, in this working directory.
std::string print_user_problem(const UserProblem& own);

// The text of a grid with its files named from another folder.
std::string moved_grid_text(std::string_view toml, const std::string& file_name,
                            const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace tribench::user
