// SPDX-License-Identifier: MIT
//
// The one rule for names in formulas: a letter or _, then letters, digits and _ (ASCII); not a
// function's name, and not the prefix sgn_ alone. Whatever reads names from outside (columns of a
// file, boxes, arguments) asks here, so that a formula reads back as what it was and no text from
// outside enters code.
//
// Not for names that never stand in a formula (columns that are not used, problems, methods).
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace tribench {

// The functions of formulas, by the names that no input can have.
inline constexpr std::array<std::string_view, 9> kFunctionNames = {
    "exp", "log", "sqrt", "abs", "sgn", "sin", "cos", "tanh", "atan"};

bool is_identifier(std::string_view name);    // the letters alone
bool is_formula_name(std::string_view name);  // and no function

// The name to give in its stead: "q [deg]" -> "q_deg", "1e5" -> "x1e5", "exp" -> "exp_".
std::string formula_name_for(std::string_view name);

// Throws Error (bad_input) that says which name cannot stand in a formula and what to call it.
void require_formula_name(std::string_view name, std::string_view place);

}  // namespace tribench
