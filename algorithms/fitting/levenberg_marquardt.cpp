// SPDX-License-Identifier: MIT
#include "algorithms/fitting/levenberg_marquardt.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/fitting/cholesky.hpp"

namespace tribench {
namespace {

constexpr double kFirstDamping = 1e-1;
constexpr double kLeastDamping = 1e-12;
constexpr double kMostDamping = 1e16;  // beyond it no step can change a double
constexpr double kGoodModel = 0.95;    // gain ratio from which the damping falls fast
constexpr double kFastFall = 0.05;
constexpr double kSlowestFall = 1.0 / 3.0;  // Nielsen 1999

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

// Sums at the point evaluated last; false where they are not finite.
bool LevenbergMarquardt::update_sums(LeastSquaresProblem& problem) {
  problem.normal_equations(sums_);
  if (!all_finite(sums_.gradient) || !all_finite(sums_.curvature)) return false;
  const std::size_t p = column_norms_.size();
  for (std::size_t k = 0; k < p; ++k) {
    column_norms_[k] = std::max(column_norms_[k], sums_.curvature[k * p + k]);
  }
  return true;
}

// At a bound, with the descent pointing outwards.
bool LevenbergMarquardt::is_held(std::size_t k, double x,
                                 const LevenbergMarquardtOptions& options) const {
  if (!options.low.empty() && x <= options.low[k] && sums_.gradient[k] > 0) return true;
  return !options.high.empty() && x >= options.high[k] && sums_.gradient[k] < 0;
}

// (J^T J + damping D) step = -J^T r with D the squared column norms, solved in units in which D
// is 1. A parameter without effect, or held by its bound, stays where it is.
bool LevenbergMarquardt::solve_for_step(std::span<const double> x, double damping,
                                        const LevenbergMarquardtOptions& options) {
  const std::size_t p = x.size();
  factor_.resize(p * p);
  for (std::size_t k = 0; k < p; ++k) {
    const bool moves = column_norms_[k] > 0 && !is_held(k, x[k], options);
    scale_[k] = moves ? 1 / std::sqrt(column_norms_[k]) : 0;
  }
  for (std::size_t k = 0; k < p; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      factor_[k * p + l] = scale_[k] * scale_[l] * sums_.curvature[k * p + l];
    }
    factor_[k * p + k] += scale_[k] > 0 ? damping : 1;
  }
  if (!cholesky_factor(factor_, p)) return false;
  for (std::size_t k = 0; k < p; ++k) step_[k] = -scale_[k] * sums_.gradient[k];
  cholesky_solve(factor_, p, step_);
  for (std::size_t k = 0; k < p; ++k) {
    const double moved = x[k] + scale_[k] * step_[k];
    trial_[k] = moved;
    if (!options.low.empty()) trial_[k] = std::max(trial_[k], options.low[k]);
    if (!options.high.empty()) trial_[k] = std::min(trial_[k], options.high[k]);
    // x + (trial - x) need not be trial, but the promise is made for the step.
    step_[k] = trial_[k] == moved ? scale_[k] * step_[k] : trial_[k] - x[k];
  }
  return all_finite(step_);
}

// Of the quadratic model: -2 g^T s - s^T A s.
double LevenbergMarquardt::promised_decrease() const {
  const std::size_t p = step_.size();
  double promised = 0;
  for (std::size_t k = 0; k < p; ++k) {
    double row = 0;
    for (std::size_t l = 0; l < p; ++l) row += sums_.curvature[k * p + l] * step_[l];
    promised -= step_[k] * (2 * sums_.gradient[k] + row);
  }
  return promised;
}

double LevenbergMarquardt::largest_scaled_gradient() const {
  const std::size_t p = column_norms_.size();
  double largest = 0;
  for (std::size_t k = 0; k < p; ++k) {
    const double norm = sums_.curvature[k * p + k] * sums_.sum_squares;
    if (norm > 0) largest = std::max(largest, std::abs(sums_.gradient[k]) / std::sqrt(norm));
  }
  return largest;
}

bool LevenbergMarquardt::step_is_small(std::span<const double> x, double tolerance) const {
  double step_norm = 0;
  double norm = 0;
  for (std::size_t k = 0; k < step_.size(); ++k) {
    step_norm += column_norms_[k] * step_[k] * step_[k];
    norm += column_norms_[k] * x[k] * x[k];
  }
  return step_norm <= tolerance * tolerance * norm;
}

void LevenbergMarquardt::iterate(LeastSquaresProblem& problem, std::vector<double>& x,
                                 const LevenbergMarquardtOptions& options,
                                 LevenbergMarquardtResult& result) {
  double damping = kFirstDamping;
  double rise = 2;
  result.status = FitStatus::converged;
  while (result.iterations < options.max_iterations) {
    if (largest_scaled_gradient() <= options.gradient_tolerance) return;
    if (!problem.may_go_on()) {
      result.status = FitStatus::out_of_time;
      return;
    }
    result.iterations += 1;
    double sum = result.sum_squares;
    double gain = -1;
    if (solve_for_step(x, damping, options)) {
      if (step_is_small(x, options.step_tolerance)) return;
      sum = problem.sum_squares(trial_);
      const double promised = promised_decrease();
      gain = promised > 0 ? (result.sum_squares - sum) / promised : -1;
    }
    if (!(sum < result.sum_squares)) {  // NaN too
      damping *= rise;
      rise *= 2;
      if (damping > kMostDamping) return;  // no step, however small, improves
      continue;
    }
    const double decrease = (result.sum_squares - sum) / result.sum_squares;
    std::swap(x, trial_);
    result.sum_squares = sum;
    const double shortfall = 2 * std::min(gain, 1.0) - 1;
    damping *= gain > kGoodModel ? kFastFall
                                 : std::max(kSlowestFall, 1 - shortfall * shortfall * shortfall);
    damping = std::max(damping, kLeastDamping);
    rise = 2;
    if (decrease <= options.function_tolerance && gain > kSlowestFall) return;
    if (!update_sums(problem)) {
      result.status = FitStatus::not_finite;
      return;
    }
  }
  result.status = FitStatus::max_iterations;
}

LevenbergMarquardtResult LevenbergMarquardt::minimize(LeastSquaresProblem& problem,
                                                      std::vector<double>& x,
                                                      const LevenbergMarquardtOptions& options) {
  LevenbergMarquardtResult result;
  result.status = FitStatus::not_finite;
  result.sum_squares = problem.sum_squares(x);
  if (!std::isfinite(result.sum_squares)) return result;
  if (x.empty()) {
    result.status = FitStatus::no_constants;
    return result;
  }
  trial_.resize(x.size());
  step_.resize(x.size());
  scale_.resize(x.size());
  column_norms_.assign(x.size(), 0);
  if (update_sums(problem)) iterate(problem, x, options, result);
  return result;
}

}  // namespace tribench
