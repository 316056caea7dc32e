// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algorithms/expression/edit.hpp"
#include "algorithms/fitting/shape_dimension.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Mean squares below this share of the target's are rounding.
constexpr double kRounding = 1e-28;

}  // namespace

double evidence_price(const Expression& formula, std::size_t rows, double node_price) {
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!is_exponent(formula, i)) ++nodes;
  }
  return 0.5 * static_cast<double>(shape_dimension(formula)) *
             elementary::log(static_cast<double>(rows)) +
         node_price * static_cast<double>(nodes);
}

double evidence_against(const Expression& formula, double mean_square, double zero_loss,
                        std::size_t rows, double node_price) {
  const double square = std::max({mean_square, kRounding * zero_loss, 1e-300});
  return 0.5 * static_cast<double>(rows) * (elementary::log(2 * std::numbers::pi * square) + 1) +
         evidence_price(formula, rows, node_price);
}

}  // namespace tribench
