// SPDX-License-Identifier: MIT
//
// A file that is written whole or not at all. Not for what grows while it is written (a journal,
// a log): that is appended to where it stands.
#pragma once

#include <filesystem>
#include <string_view>

namespace tribench {

// Writes the text beside its place and renames it, so that a reader sees the old file or the new,
// never half of one. A link is followed; what is no file (a pipe, a terminal, /dev/null) is written
// to as it is. Throws Error naming the file (bad_input: the name is wrong) and leaves nothing.
void write_file(const std::filesystem::path& file, std::string_view text);

// Before long work: throws what write_file would for this file, and leaves it as it is.
void try_output_file(const std::filesystem::path& file);

}  // namespace tribench
