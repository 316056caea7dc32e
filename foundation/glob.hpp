// SPDX-License-Identifier: MIT
//
// Patterns over names: of problems, methods, cells. Not for paths: '/' is a character like others,
// and there are no classes ([a-z]) and no escapes.
#pragma once

#include <string_view>

namespace tribench {

// '*' stands for any number of characters, '?' for one; everything else for itself. Cost: at worst
// the product of the lengths.
bool glob_matches(std::string_view glob, std::string_view text);

}  // namespace tribench
