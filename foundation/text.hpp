// SPDX-License-Identifier: MIT
//
// Text in pieces and whole files. Bytes throughout: nothing here depends on the locale.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

// Without blanks, tabs and line ends on either side.
std::string_view trimmed(std::string_view text);

// The pieces between separators, trimmed: "a, b" at ',' gives "a" and "b"; "a,,b" has an empty
// piece; an empty or blank text has none.
std::vector<std::string> split(std::string_view text, char separator);

// All bytes of a file. Throws Error (bad_input) where it cannot be read.
std::string read_file(const std::filesystem::path& file);
// Nothing where there is no such file or it cannot be read.
std::optional<std::string> read_file_if_there(const std::filesystem::path& file);

}  // namespace tribench
