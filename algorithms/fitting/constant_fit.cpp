// SPDX-License-Identifier: MIT
//
// Levenberg-Marquardt on the normal equations. The damping is relative to the squared norms of the
// Jacobian's columns, the largest seen so far (More 1978), so that the result does not depend on
// the units of the constants; it follows the ratio of the decrease won to the decrease promised
// (Nielsen 1999), but falls faster where the quadratic model holds. We differ from both in that a
// step counts only by its value: the constants returned are the best seen.
#include "algorithms/fitting/constant_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/fitting/cholesky.hpp"

namespace tribench {
namespace {

constexpr double kFirstDamping = 1e-2;
constexpr double kLeastDamping = 1e-12;
constexpr double kMostDamping = 1e16;  // beyond it no step can change a double
constexpr double kGoodModel = 0.9;     // gain ratio from which the damping falls fast
constexpr double kFastFall = 0.05;
constexpr double kSlowestFall = 1.0 / 3.0;  // Nielsen 1999

// A backward pass with its sums costs about two forward passes (bench/fitting_bench).
constexpr std::uint64_t kJacobianCost = 2;

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

struct ConstantFitter::Workspace {
  // The problem, as long as a fit runs.
  const Inputs* inputs = nullptr;
  std::span<const double> target;
  std::span<const double> weights;
  std::uint64_t pass_cost = 0;

  Differentiator differentiator;
  NormalEquations sums;
  std::vector<std::size_t> places;
  std::vector<double> constants;  // the best
  std::vector<double> trial;
  std::vector<double> column_norms;  // largest squared norm seen of each column of J
  std::vector<double> factor;
  std::vector<double> step;

  void choose_constants(const Expression& formula, bool fit_exponents);
  bool normal_equations(ConstantFitResult& result);
  bool solve_for_step(double damping);
  double promised_decrease(double damping) const;
  double largest_scaled_gradient() const;
  bool step_is_small(double tolerance) const;
  void run(const ConstantFitOptions& options, ConstantFitResult& result);
};

void ConstantFitter::Workspace::choose_constants(const Expression& formula, bool fit_exponents) {
  places.clear();
  constants.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!formula.node(i).is_constant()) continue;
    // An exponent is a right child, so its parent is the next place of the tape.
    const bool exponent = i + 1 < formula.size() && formula.node(i + 1).op == Op::pow;
    if (exponent && !fit_exponents) continue;
    places.push_back(i);
    constants.push_back(formula.node(i).value);
  }
}

// Sums at `constants`; false where they are not finite.
bool ConstantFitter::Workspace::normal_equations(ConstantFitResult& result) {
  differentiator.normal_equations(*inputs, target, weights, sums);
  result.node_rows += kJacobianCost * pass_cost;
  if (!all_finite(sums.gradient) || !all_finite(sums.curvature)) return false;
  const std::size_t p = constants.size();
  for (std::size_t k = 0; k < p; ++k) {
    column_norms[k] = std::max(column_norms[k], sums.curvature[k * p + k]);
  }
  return true;
}

// (J^T J + damping D) step = -J^T r with D the squared column norms, solved in units in which D
// is 1. A constant without effect stays where it is.
bool ConstantFitter::Workspace::solve_for_step(double damping) {
  const std::size_t p = constants.size();
  factor.resize(p * p);
  for (std::size_t k = 0; k < p; ++k) {
    step[k] = column_norms[k] > 0 ? 1 / std::sqrt(column_norms[k]) : 0;
  }
  for (std::size_t k = 0; k < p; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      factor[k * p + l] = step[k] * step[l] * sums.curvature[k * p + l];
    }
    factor[k * p + k] += step[k] > 0 ? damping : 1;
  }
  if (!cholesky_factor(factor, p)) return false;
  for (std::size_t k = 0; k < p; ++k) step[k] *= -sums.gradient[k];
  cholesky_solve(factor, p, step);
  for (std::size_t k = 0; k < p; ++k) {
    step[k] = column_norms[k] > 0 ? step[k] / std::sqrt(column_norms[k]) : 0;
  }
  return all_finite(step);
}

double ConstantFitter::Workspace::promised_decrease(double damping) const {
  double promised = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    promised += step[k] * (damping * column_norms[k] * step[k] - sums.gradient[k]);
  }
  return promised;
}

// The largest cosine between the residual and a column of J.
double ConstantFitter::Workspace::largest_scaled_gradient() const {
  double largest = 0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const double norm = sums.curvature[k * constants.size() + k] * sums.sum_squares;
    if (norm > 0) largest = std::max(largest, std::abs(sums.gradient[k]) / std::sqrt(norm));
  }
  return largest;
}

bool ConstantFitter::Workspace::step_is_small(double tolerance) const {
  double step_norm = 0;
  double norm = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    step_norm += column_norms[k] * step[k] * step[k];
    norm += column_norms[k] * constants[k] * constants[k];
  }
  return step_norm <= tolerance * tolerance * norm;
}

void ConstantFitter::Workspace::run(const ConstantFitOptions& options, ConstantFitResult& result) {
  double damping = kFirstDamping;
  double rise = 2;
  while (result.iterations < options.max_iterations) {
    if (largest_scaled_gradient() <= options.gradient_tolerance) {
      result.status = FitStatus::converged;
      return;
    }
    result.iterations += 1;
    double sum = result.sum_squares;
    double gain = -1;
    if (solve_for_step(damping)) {
      if (step_is_small(options.step_tolerance)) {
        result.status = FitStatus::converged;
        return;
      }
      for (std::size_t k = 0; k < step.size(); ++k) trial[k] = constants[k] + step[k];
      differentiator.set_constants(trial);
      sum = differentiator.sum_squares(*inputs, target, weights);
      result.node_rows += pass_cost;
      const double promised = promised_decrease(damping);
      gain = promised > 0 ? (result.sum_squares - sum) / promised : -1;
    }
    if (!(sum < result.sum_squares)) {  // NaN too
      damping *= rise;
      rise *= 2;
      if (damping > kMostDamping) {
        result.status = FitStatus::converged;  // no step, however small, improves
        return;
      }
      continue;
    }
    const double decrease = (result.sum_squares - sum) / result.sum_squares;
    std::swap(constants, trial);
    result.sum_squares = sum;
    const double shortfall = 2 * std::min(gain, 1.0) - 1;
    damping *= gain > kGoodModel ? kFastFall
                                 : std::max(kSlowestFall, 1 - shortfall * shortfall * shortfall);
    damping = std::max(damping, kLeastDamping);
    rise = 2;
    if (decrease <= options.function_tolerance && gain > kSlowestFall) {
      result.status = FitStatus::converged;
      return;
    }
    if (!normal_equations(result)) {
      result.status = FitStatus::not_finite;
      return;
    }
  }
  result.status = FitStatus::max_iterations;
}

ConstantFitter::ConstantFitter() : workspace_(std::make_unique<Workspace>()) {}
ConstantFitter::~ConstantFitter() = default;
ConstantFitter::ConstantFitter(ConstantFitter&&) noexcept = default;
ConstantFitter& ConstantFitter::operator=(ConstantFitter&&) noexcept = default;

ConstantFitResult ConstantFitter::fit(Expression& formula, const Inputs& inputs,
                                      std::span<const double> target,
                                      std::span<const double> weights,
                                      const ConstantFitOptions& options) {
  Workspace& work = *workspace_;
  ConstantFitResult result;
  work.inputs = &inputs;
  work.target = target;
  work.weights = weights;
  work.pass_cost = node_rows(formula, inputs.rows);
  work.choose_constants(formula, options.fit_exponents);
  work.differentiator.prepare(formula, work.places);
  result.sum_squares = work.differentiator.sum_squares(inputs, target, weights);
  result.node_rows = work.pass_cost;
  if (!std::isfinite(result.sum_squares)) {
    result.status = FitStatus::not_finite;
    return result;
  }
  if (work.places.empty()) return result;
  const std::size_t p = work.places.size();
  work.trial.resize(p);
  work.step.resize(p);
  work.column_norms.assign(p, 0);
  if (!work.normal_equations(result)) {
    result.status = FitStatus::not_finite;
    return result;
  }
  work.run(options, result);
  for (std::size_t k = 0; k < p; ++k) formula.set_constant(work.places[k], work.constants[k]);
  return result;
}

}  // namespace tribench
