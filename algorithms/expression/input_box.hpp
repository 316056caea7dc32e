// SPDX-License-Identifier: MIT
//
// The box of inputs that a proof ranges over, and its text form 'v=-2:2,g=-60:60'.
//
// An input named sgn_X beside X is the sign of X (-1, 0, 1; 0 at 0) and not independent of it: it
// carries the place of X instead of a range.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// An input called so and after another is that one's sign: "sgn_v".
inline constexpr std::string_view kSignPrefix = "sgn_";

// The range of one input, in the order of the formula's columns.
struct InputRange {
  double low = 0;
  double high = 0;
  // This input is the sign of that one; low and high then mean nothing.
  std::optional<std::size_t> sign_of = {};
};
using InputBox = std::vector<InputRange>;

struct NamedBox {
  std::vector<std::string> names;
  InputBox ranges;  // in the order of names
};

// Reads NAME=LOW:HIGH, separated by commas. A name sgn_X beside X needs no range and is left out.
// Throws Error (bad_input) that says which part is wrong, or that sgn_X has less than X gives it.
NamedBox parse_box(std::string_view text);
std::string print_box(const NamedBox& box);

// Parses a formula over the box's names; where it uses sgn_X beside an X of the box, sgn_X is added
// to the box. Throws Error (bad_input) on any other name.
Expression parse_over(std::string_view formula, NamedBox& box);

// Gives the signs of a point, one number an input, the values that they have there.
void set_signs(const InputBox& box, std::vector<double>& point);

// Throws Error (bad_input) where a range is not one (NaN, infinite, low > high), a sign is that of
// no input with a range, or the formula uses a column beyond the box.
void check_box(const Expression& formula, const InputBox& box);

}  // namespace tribench
