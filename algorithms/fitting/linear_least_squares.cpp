// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_least_squares.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/pivoted_qr.hpp"

namespace tribench {
namespace {

constexpr double kRankTolerance = 1e-10;

// The free minimum over the coefficients in `free`; the others are 0.
bool solve_free(std::span<const double> a, std::span<const double> b,
                const std::vector<std::size_t>& free, std::span<double> solution) {
  const auto p = static_cast<Eigen::Index>(free.size());
  const std::size_t n = b.size();
  std::ranges::fill(solution, 0.0);
  if (p == 0) return true;
  Eigen::MatrixXd matrix(p, p);
  Eigen::VectorXd rhs(p);
  Eigen::VectorXd scale(p);
  for (Eigen::Index i = 0; i < p; ++i) {
    const double diagonal = a[free[static_cast<std::size_t>(i)] * (n + 1)];
    scale[i] = diagonal > 0 ? 1 / std::sqrt(diagonal) : 0;
  }
  for (Eigen::Index i = 0; i < p; ++i) {
    const std::size_t row = free[static_cast<std::size_t>(i)];
    rhs[i] = scale[i] * b[row];
    for (Eigen::Index j = 0; j < p; ++j) {
      matrix(i, j) = scale[i] * scale[j] * a[row * n + free[static_cast<std::size_t>(j)]];
    }
  }
  const Eigen::VectorXd x = PivotedQr(matrix, kRankTolerance).solve(rhs).cwiseProduct(scale);
  for (Eigen::Index i = 0; i < p; ++i) solution[free[static_cast<std::size_t>(i)]] = x[i];
  return x.allFinite();
}

double quadratic(std::span<const double> a, std::span<const double> b, std::span<const double> x) {
  double value = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    double row = 0;
    for (std::size_t j = 0; j < b.size(); ++j) row += a[i * b.size() + j] * x[j];
    value += x[i] * (0.5 * row - b[i]);
  }
  return value;
}

bool is_feasible(std::span<const char> non_negative, std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (non_negative[i] != 0 && x[i] < 0) return false;
  }
  return true;
}

}  // namespace

LinearFit solve_least_squares(std::span<const double* const> columns,
                              std::span<const double> target) {
  const auto rows = static_cast<Eigen::Index>(target.size());
  const auto p = static_cast<Eigen::Index>(columns.size());
  LinearFit fit;
  fit.coefficients.assign(columns.size(), 0.0);
  const Eigen::Map<const Eigen::VectorXd> y(target.data(), rows);
  if (rows == 0 || p == 0) {
    fit.sum_squares = y.squaredNorm();
    return fit;
  }
  Eigen::MatrixXd design(rows, p);
  Eigen::VectorXd scale(p);
  for (Eigen::Index k = 0; k < p; ++k) {
    const Eigen::Map<const Eigen::VectorXd> column(columns[static_cast<std::size_t>(k)], rows);
    // stableNorm does not overflow on columns of 1e200.
    const double norm = column.stableNorm();
    scale[k] = norm > 0 && std::isfinite(norm) ? 1 / norm : 0;
    // A column of subnormal numbers has no scale: like one of zeros it gets the coefficient 0.
    if (!std::isfinite(scale[k])) scale[k] = 0;
    design.col(k) = column * scale[k];
  }
  const PivotedQr qr(design, kRankTolerance);
  const Eigen::VectorXd solution = qr.solve(y);
  for (Eigen::Index k = 0; k < p; ++k) {
    fit.coefficients[static_cast<std::size_t>(k)] = solution[k] * scale[k];
  }
  fit.sum_squares = (design * solution - y).squaredNorm();
  fit.rank = static_cast<int>(qr.rank());
  fit.condition = qr.condition();
  return fit;
}

bool solve_quadratic(std::span<const double> a, std::span<const double> b,
                     std::span<const char> non_negative, std::span<double> solution) {
  const std::size_t n = b.size();
  std::vector<std::size_t> held;
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < n; ++i) {
    if (non_negative[i] != 0) held.push_back(i);
    free.push_back(i);
  }
  if (solve_free(a, b, free, solution) && is_feasible(non_negative, solution)) return true;
  double best_value = std::numeric_limits<double>::infinity();
  std::vector<double> trial(n);
  std::vector<double> best(n, 0.0);
  for (unsigned active = 1; active < (1U << held.size()); ++active) {
    free.clear();
    std::size_t next_held = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool at_zero = non_negative[i] != 0 && ((active >> next_held++) & 1U) != 0;
      if (!at_zero) free.push_back(i);
    }
    if (!solve_free(a, b, free, trial) || !is_feasible(non_negative, trial)) continue;
    const double value = quadratic(a, b, trial);
    if (!(value < best_value)) continue;
    best_value = value;
    best = trial;
  }
  std::ranges::copy(best, solution.begin());
  return std::isfinite(best_value);
}

}  // namespace tribench
