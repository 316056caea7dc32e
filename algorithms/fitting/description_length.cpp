// SPDX-License-Identifier: MIT
#include "algorithms/fitting/description_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "algorithms/expression/edit.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kLeastRelativeError = 1e-12;

// Different symbols: each operation, each variable, and "constant" once.
std::size_t symbols_of(const Expression& formula) {
  std::set<std::pair<Op, std::uint16_t>> symbols;
  for (const Node& node : formula.nodes()) symbols.insert({node.op, node.variable});
  return symbols.size();
}

}  // namespace

double description_length(const Expression& formula, const Inputs& inputs,
                          std::span<const double> target, Differentiator& differentiator) {
  // Whole exponents belong to the structure; all other constants are parameters.
  std::vector<std::size_t> places = constant_positions(formula);
  std::erase_if(places, [&](std::size_t i) { return is_exponent(formula, i); });
  differentiator.prepare(formula, places);
  NormalEquations sums;
  differentiator.normal_equations(inputs, target, {}, sums);
  if (!std::isfinite(sums.sum_squares)) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(target.size());
  double size = 0;
  for (double y : target) size += y * y;
  const double floor = kLeastRelativeError * kLeastRelativeError * std::max(size, 1e-300);
  const double variance = std::max(sums.sum_squares, floor) / n;
  double length = 0.5 * n * elementary::log(variance);
  length += static_cast<double>(formula.size()) *
            elementary::log(static_cast<double>(std::max<std::size_t>(symbols_of(formula), 2)));
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double information = sums.curvature[k * places.size() + k] / variance;
    const double value = std::abs(formula.node(places[k]).value);
    if (!(information > 0) || value == 0) continue;
    length += std::max(0.0, elementary::log(value) + 0.5 * elementary::log(information / 3));
  }
  return length;
}

}  // namespace tribench
