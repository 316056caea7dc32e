// SPDX-License-Identifier: MIT
//
// A data file's text in UTF-8: unpacked where it is gzip (told by its first bytes, not by its
// name), from UTF-16 where it has that mark, from Latin-1 where it is no UTF-8.
#pragma once

#include <filesystem>
#include <string>

namespace tribench {

// Throws Error: bad_input where the file cannot be read, is a folder or its packing is damaged or
// opens to more than 16 GiB; failed where reading stops half way.
std::string read_file_text(const std::filesystem::path& file);

}  // namespace tribench
