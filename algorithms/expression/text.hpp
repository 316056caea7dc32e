// SPDX-License-Identifier: MIT
//
// Formulas as text, in and out. The grammar (binding from loose to tight):
//
//   sum     = product { ("+" | "-") product }
//   product = factor { ("*" | "/") factor }
//   factor  = "-" factor | power
//   power   = atom [ "^" factor ]                 (groups to the right, tighter than unary minus)
//   atom    = number | name | function "(" sum ")" | "(" sum ")"
//
// Functions are exp log sqrt abs sgn sin cos tanh atan; tan, sinh, cosh, log2, log10, asin and acos
// are read, too, and written out by them: no formula is printed so.
//
// A minus directly before a number that is not the base of a power is part of the number.
// parse(print(f)) is f, node for node and bit for bit, for every tape whose constants are finite.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

inline constexpr int kMaxNesting = 1000;

// Names of the variables: names[i] is column i. Throws Error (bad_input) that says at which
// character what was expected; an unknown name is answered with the nearest known one.
Expression parse(std::string_view text, std::span<const std::string> names);

// As above; names that are not in `names` are added to it in order of appearance.
Expression parse_collecting_names(std::string_view text, std::vector<std::string>& names);

// A name that is called like a function and is none: f(v, abs(w)), or p() without arguments.
struct Hole {
  std::string name;
  std::vector<Expression> arguments;  // over the names; none holds a hole itself
};

// As parse, of a formula with holes: hole k, in order of appearance, is the variable
// names.size() + k. Refuses a hole inside another's arguments, and one that stands twice.
Expression parse_with_holes(std::string_view text, std::span<const std::string> names,
                            std::vector<Hole>& holes);

// Throws Error (failed) where a column has no name, (bad_input) where its name is none that a
// formula can hold (foundation/formula_name.hpp).
std::string print(const Expression& formula, std::span<const std::string> names);

// The shortest text that reads back as the same double.
std::string print_number(double value);

}  // namespace tribench
