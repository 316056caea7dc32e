// SPDX-License-Identifier: MIT
#include "algorithms/fitting/free_constants.hpp"

#include <cmath>

#include "algorithms/expression/edit.hpp"

namespace tribench {

std::vector<std::size_t> free_constants(const Expression& formula) {
  const auto is_form = [&](std::size_t place) {
    const double value = formula.node(place).value;
    return place + 1 < formula.size() && formula.node(place + 1).op == Op::pow &&
           value == std::round(value);
  };
  std::vector<std::size_t> places = constant_positions(formula);
  std::erase_if(places, is_form);
  return places;
}

bool is_simple_exponent(double exponent) {
  return 2 * exponent == std::nearbyint(2 * exponent) ||
         std::abs(3 * exponent - std::nearbyint(3 * exponent)) <= 1e-12 * std::abs(exponent);
}

std::size_t free_exponents(const Expression& formula) {
  std::size_t count = 0;
  for (const std::size_t p : constant_positions(formula)) {
    if (is_exponent(formula, p) && !is_simple_exponent(formula.node(p).value)) ++count;
  }
  return count;
}

double nearest_simple_exponent(double exponent) {
  const double half = std::nearbyint(2 * exponent) / 2;
  const double third = std::nearbyint(3 * exponent) / 3;
  return std::abs(half - exponent) <= std::abs(third - exponent) ? half : third;
}

}  // namespace tribench
