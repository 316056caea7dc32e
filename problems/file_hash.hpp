// SPDX-License-Identifier: MIT
//
// SHA-256, which says whether a file is still the one that was named. Lower-case hexadecimal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tribench {

// Of a file's bytes. Throws Error (bad_input) where it cannot be read.
std::string sha256_of(const std::filesystem::path& file);
std::string sha256_of_text(std::string_view text);

}  // namespace tribench
