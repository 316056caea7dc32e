// SPDX-License-Identifier: MIT
#include "harness/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tribench {

ErrorFigures compute_errors(std::span<const double> values, std::span<const double> target) {
  ErrorFigures figures;
  double sum_absolute = 0;
  double sum_squares = 0;
  double largest = 0;
  double sum_target = 0;
  double target_squares = 0;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (std::size_t r = 0; r < target.size(); ++r) {
    if (!std::isfinite(target[r])) continue;
    ++figures.rows;
    if (!std::isfinite(values[r])) ++figures.not_finite;
    const double error = values[r] - target[r];
    sum_absolute += std::abs(error);
    sum_squares += error * error;
    largest = std::max(largest, std::abs(error));
    sum_target += target[r];
    target_squares += target[r] * target[r];
    lowest = std::min(lowest, target[r]);
    highest = std::max(highest, target[r]);
  }
  if (figures.rows == 0 || figures.not_finite > 0) return figures;
  const double n = static_cast<double>(figures.rows);
  double spread = 0;
  for (const double y : target) {
    if (std::isfinite(y)) spread += (y - sum_target / n) * (y - sum_target / n);
  }
  figures.mae = sum_absolute / n;
  figures.rmse = std::sqrt(sum_squares / n);
  figures.max_error = largest;
  // Of a constant the spread may be the rounding of the mean.
  if (lowest < highest) figures.r2 = 1 - sum_squares / spread;
  if (target_squares > 0) figures.relative = 100 * std::sqrt(sum_squares / target_squares);
  if (sum_squares == 0) figures.relative = 0;
  return figures;
}

}  // namespace tribench
