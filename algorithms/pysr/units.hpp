// SPDX-License-Identifier: MIT
//
// Dimensional analysis with wildcards: a constant may take any unit.
//
// Source: SymbolicRegression.jl, DimensionalAnalysis.jl. Ours differs in two points: an angle is a
// dimension of its own only where the input's unit is not "rad" (rad is a number), and a whole
// constant power multiplies the unit as the product it stands for.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

// Powers of m, kg, s, A, K, mol, cd.
struct Dimension {
  std::array<double, 7> power{};
  bool wildcard = false;  // holds a free constant as a factor: any unit will do
  bool same_powers(const Dimension& other) const { return power == other.power; }
};

// "N m", "rad/s", "m/s^2", "1/s", "-" and "" (a number). Throws Error (bad_input) with the unknown
// symbol.
Dimension parse_unit(std::string_view text);

// The formula's dimension; none where an operation breaks the rules.
std::optional<Dimension> dimension_of(const Expression& formula, std::span<const Dimension> inputs);

// Whether the formula has consistent units and ends in `target` (where given).
bool units_agree(const Expression& formula, std::span<const Dimension> inputs,
                 const std::optional<Dimension>& target);

}  // namespace tribench::pysr
