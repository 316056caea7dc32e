// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evaluation_error.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "algorithms/expression/bounds.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostRows = 16;
constexpr double kLost = 1e-6;  // of the target's range

}  // namespace

double largest_evaluation_error(const Expression& formula, const Inputs& inputs) {
  FormulaBounds bounds(formula);
  const std::size_t count = std::min(kMostRows, inputs.rows);
  std::vector<Interval> point(inputs.columns.size());
  double largest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t row = k * inputs.rows / count;
    for (std::size_t j = 0; j < point.size(); ++j) {
      // To the next double: of a point nothing but its value is bounded.
      const double x = inputs.columns[j][row];
      point[j] = {x, std::nextafter(x, HUGE_VAL)};
    }
    if (!bounds.sharpen(point)) return HUGE_VAL;
    largest = std::max(largest, bounds.rounding_error(formula.root()));
  }
  return largest;
}

bool loses_its_digits(const Expression& formula, const Inputs& inputs,
                      std::span<const double> target) {
  const auto [least, most] = std::ranges::minmax(target);
  const double error = largest_evaluation_error(formula, inputs);
  // Where nothing is known nothing is held against it: a value at the edge of what it is finite in.
  return std::isfinite(error) && error > kLost * (most - least) && most > least;
}

}  // namespace tribench
