// SPDX-License-Identifier: MIT
//
// Names that exported code cannot use as they are, in any of its languages: one list for all, so
// that an argument is called the same everywhere.
#pragma once

#include <string>
#include <string_view>

namespace tribench {

// A keyword, a macro, a function or a variable of C, C++, Python, MATLAB or of the code around the
// formula; or a name that C leaves to compilers (two underscores, one and a capital) or that MATLAB
// does not take (an underscore in front).
bool is_reserved_word(std::string_view name);

// The name where nothing speaks against it, else one like it: if -> if_, _v -> x_v.
std::string unreserved(std::string_view name);

}  // namespace tribench
