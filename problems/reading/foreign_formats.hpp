// SPDX-License-Identifier: MIT
//
// Files that hold a recording and are no delimited text: archives, workbooks, MATLAB's and numpy's
// files, bags, JSON, HTML, a folder. None is read: each is said to be what it is, with how to make
// a table of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace tribench {

// Throws Error (bad_input) where the bytes begin as such a file does.
void refuse_foreign_bytes(std::string_view bytes, std::string_view file);

// The same of a text whose first line that holds anything is `first`.
void refuse_foreign_text(std::string_view first, std::string_view file, std::size_t line);

// The same of a folder.
void refuse_folder(const std::filesystem::path& file);

}  // namespace tribench
