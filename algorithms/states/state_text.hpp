// SPDX-License-Identifier: MIT
//
// Formulas with states as text, in and out:
//
//   z = lugre(v, sliding=1e-05, breakaway=1.5e-05, stribeck_velocity=0.01); 2e6*z + 100*v
//
// Declarations stand before the formula, each ended by a semicolon: the law, the inputs that drive
// it in their order, its parameters by name in any order. The formula reads a state by its name. A
// text without a semicolon is a formula without states.
//
// Errors are Error (bad_input) that names the declaration, what is wrong and what to write.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/states/state_law.hpp"

namespace tribench {

// A formula over inputs and, from column `first_state` on, states in the order declared.
struct StatefulFormula {
  std::vector<StateDeclaration> states;
  std::size_t first_state = 0;  // the number of inputs
  Expression formula;
};

// Whether the text declares a state.
bool declares_states(std::string_view text);

// Column j < names.size() is input names[j]; states follow.
StatefulFormula parse_stateful(std::string_view text, std::span<const std::string> names);

// As above; names that are not in `names` are added to it in order of appearance, drives first.
StatefulFormula parse_stateful_collecting(std::string_view text, std::vector<std::string>& names);

// Over a box, to which each state is added with the range it stays in from rest (state_range), and
// signs sgn_X where the formula has them (parse_over). Columns are the box's then, in its order.
StatefulFormula parse_stateful_over(std::string_view text, NamedBox& box);

// The reverse; states that the formula does not read are left out. names: of the inputs.
std::string print_stateful(const StatefulFormula& formula, std::span<const std::string> names);

// "lugre(v, sliding=1e-05, ...)"
std::string print_state_law(const StateDeclaration& state, std::span<const std::string> names);

// The declaration of a state of that name by such a text, as of a problem's input with a law.
StateDeclaration parse_state_law(std::string_view name, std::string_view law,
                                 std::span<const std::string> names);

}  // namespace tribench
