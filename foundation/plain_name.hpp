// SPDX-License-Identifier: MIT
//
// The one rule for names that a user gives to things and that end up in cell keys, folders, CSV
// files, pages, pictures and scripts: with it none of these can be broken or made to run something.
// Not for columns of data, which stand in formulas: formula_name.hpp.
#pragma once

#include <string_view>

namespace tribench {

// 1 to 64 of A-Z a-z 0-9 _ . + -, the first a letter or a digit.
bool is_plain_name(std::string_view name);

// Throws Error (bad_input) with the rule. `what`: "a method", "the grid".
void require_plain_name(std::string_view name, std::string_view what, std::string_view place);

}  // namespace tribench
