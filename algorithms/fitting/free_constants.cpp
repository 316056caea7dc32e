// SPDX-License-Identifier: MIT
#include "algorithms/fitting/free_constants.hpp"

#include <cmath>

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

}  // namespace tribench
