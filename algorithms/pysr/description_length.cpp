// SPDX-License-Identifier: MIT
#include "algorithms/pysr/description_length.hpp"
#include "algorithms/pysr/dimension.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

// Mean squares below this share of the target's are rounding.
constexpr double kRounding = 1e-28;

double structure_length(const Expression& formula) {
  std::set<std::pair<Op, int>> symbols;
  double length = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    symbols.insert({node.op, node.is_variable() ? node.variable : 0});
    if (is_exponent(formula, i) && node.value != 0)
      length += std::abs(std::log(std::abs(node.value)));
  }
  return length + static_cast<double>(formula.size()) *
                      std::log(std::max<double>(2, static_cast<double>(symbols.size())));
}

double data_length(double mean_square, double zero_square, double rows) {
  const double square = std::max({mean_square, kRounding * zero_square, 1e-300});
  return 0.5 * rows * (std::log(2 * std::numbers::pi * square) + 1);
}

}  // namespace

std::optional<double> description_length(const Expression& formula, const Rows& rows,
                                         Differentiator& workspace) {
  const std::size_t n = rows.size();
  std::vector<std::size_t> places;
  for (const std::size_t place : formula.constant_positions()) {
    if (!is_exponent(formula, place)) places.push_back(place);
  }
  const std::size_t p = places.size();
  if (n <= p) return std::nullopt;
  workspace.prepare(formula, places);
  NormalEquations sums;
  workspace.normal_equations(rows.inputs(), rows.target, {}, sums);
  if (!std::isfinite(sums.sum_squares)) return std::nullopt;
  const double zero = columns::dot(rows.target.data(), rows.target.data(), n);
  const double square = std::max(sums.sum_squares, kRounding * zero) / static_cast<double>(n - p);
  double parameters = 0;
  for (std::size_t k = 0; k < p && square > 0; ++k) {
    const double information = sums.curvature[k * p + k] / square;
    const double size = std::abs(formula.node(places[k]).value);
    if (!std::isfinite(information)) return std::nullopt;
    if (size * size * information < 12) continue;
    parameters += 0.5 * std::log(information) + std::log(size) - 0.5 * std::log(3.0);
  }
  return structure_length(formula) + parameters +
         data_length(square, zero / static_cast<double>(n), static_cast<double>(n));
}

double evidence_price(const Expression& formula, std::size_t rows) {
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!is_exponent(formula, i)) ++nodes;
  }
  return 0.5 * static_cast<double>(shape_dimension(formula)) * std::log(static_cast<double>(rows)) +
         kNodePrice * static_cast<double>(nodes);
}

double evidence_against(const Expression& formula, double mean_square, double zero_loss,
                        std::size_t rows) {
  return data_length(mean_square, zero_loss, static_cast<double>(rows)) +
         evidence_price(formula, rows);
}

}  // namespace tribench::pysr
