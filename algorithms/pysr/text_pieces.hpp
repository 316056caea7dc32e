// SPDX-License-Identifier: MIT
//
// Cuts the texts of parameters ("exp=2; ^=3") into their pieces.
#pragma once

#include <string_view>
#include <vector>

namespace tribench::pysr {

// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

// The pieces between separators, trimmed; empty ones are left out.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace tribench::pysr
