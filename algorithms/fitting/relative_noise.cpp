// SPDX-License-Identifier: MIT
#include "algorithms/fitting/relative_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

// Less is hardly worth another fit, and many rows tell the least misfit that is larger where the
// target is (docs/settled.md).
constexpr double kNats = 10;
constexpr double kNatsOfARow = 0.1;
constexpr std::size_t kComparedRows = 1000;
// Standard errors by which neighbours' residuals go together before they are called alike.
constexpr double kAlike = 3;

// Sums over the rows for one formula.
struct Residuals {
  double square = 0;           // of the residuals
  double relative_square = 0;  // of the residuals over the values
  double log_values = 0;
};

Residuals residuals_of(std::span<const double> values, std::span<const double> target) {
  Residuals sums;
  for (std::size_t r = 0; r < values.size(); ++r) {
    const double residual = target[r] - values[r];
    sums.square += residual * residual;
    sums.relative_square += residual * residual / (values[r] * values[r]);
    sums.log_values += elementary::log(std::abs(values[r]));
  }
  return sums;
}

std::size_t nearest_row(const std::vector<std::vector<double>>& columns, std::size_t row) {
  std::size_t nearest = row;
  double least = HUGE_VAL;
  for (std::size_t other = 0; other < columns[0].size(); ++other) {
    if (other == row) continue;
    double distance = 0;
    for (const std::vector<double>& column : columns) {
      distance += (column[other] - column[row]) * (column[other] - column[row]);
    }
    if (distance < least) {
      least = distance;
      nearest = other;
    }
  }
  return nearest;
}

}  // namespace

bool leaves_only_noise(const Expression& formula, const Inputs& inputs,
                       std::span<const double> target) {
  std::vector<double> values(target.size());
  Evaluator().evaluate(formula, inputs, values);
  const std::size_t count = std::min(kComparedRows, target.size());
  const auto taken = [&](std::size_t i) { return i * target.size() / count; };
  std::vector<std::vector<double>> columns;
  for (const double* input : inputs.columns) {
    std::vector<double> column;
    for (std::size_t i = 0; i < count; ++i) column.push_back(input[taken(i)]);
    columns.push_back(ranks_of(column));
  }
  std::vector<double> left;
  for (std::size_t i = 0; i < count; ++i) {
    left.push_back((target[taken(i)] - values[taken(i)]) / values[taken(i)]);
  }
  left = ranks_of(left);
  const double middle = (static_cast<double>(count) + 1) / 2;
  double sum = 0;
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double product = (left[i] - middle) * (left[nearest_row(columns, i)] - middle);
    sum += product;
    square += product * product;
  }
  return sum <= kAlike * std::sqrt(square);
}

std::optional<std::vector<double>> weights_of_relative_noise(std::span<const Expression> front,
                                                             const Inputs& inputs,
                                                             std::span<const double> target) {
  if (target.empty() || simplest_exact(front, inputs, target)) return std::nullopt;
  const auto n = static_cast<double>(target.size());
  double zero_loss = 0;
  for (const double y : target) zero_loss += y * y / n;
  Evaluator evaluator;
  std::vector<double> values(target.size());
  double of_one_size = HUGE_VAL;  // nats against
  double in_proportion = HUGE_VAL;
  std::vector<double> best;
  for (const Expression& formula : front) {
    evaluator.evaluate(formula, inputs, values);
    const Residuals sums = residuals_of(values, target);
    if (!std::isfinite(sums.square)) continue;
    of_one_size =
        std::min(of_one_size, evidence_against(formula, sums.square / n, zero_loss, target.size()));
    if (!std::isfinite(sums.relative_square) || !std::isfinite(sums.log_values)) continue;
    const double against =
        evidence_against(formula, sums.relative_square / n, 1, target.size()) + sums.log_values;
    if (!(against < in_proportion)) continue;
    in_proportion = against;
    best = values;
  }
  if (!(of_one_size - in_proportion > std::max(kNats, kNatsOfARow * n))) return std::nullopt;
  for (double& value : best) value = 1 / (value * value);
  return best;
}

}  // namespace tribench
