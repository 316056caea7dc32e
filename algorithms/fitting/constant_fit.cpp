// SPDX-License-Identifier: MIT
//
// Constants that enter linearly are not searched: at every point the others visit they are solved
// for (variable projection, Golub & Pereyra 1973, with Kaufman's approximation of the Jacobian).
// That takes a fraction of the iterations and forgives starts that are far off. With bounds all
// constants are searched.
#include "algorithms/fitting/constant_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/fitting/cholesky.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/linear_constants.hpp"

namespace tribench {
namespace {

// A pass with derivatives and their sums costs about three forward passes (bench/fitting_bench).
constexpr std::uint64_t kPassWithSums = 3;
constexpr double kDependent = 1e-11;  // share of a column's square that must be new
// A sum of squares that is a small difference is computed again from the residuals.
constexpr double kCancelled = 1e-4;

}  // namespace

// The formula as a problem in the constants that are searched; the first `linear` of `constants`
// are solved for.
struct ConstantFitter::Workspace : public LeastSquaresProblem {
  const Inputs* inputs = nullptr;
  std::span<const double> target;
  std::span<const double> weights;
  std::uint64_t pass_cost = 0;
  std::uint64_t spent = 0;
  std::size_t linear = 0;
  InTime in_time;    // of this fit; empty: no clock is watched
  bool cut = false;  // by it

  Differentiator differentiator;
  LevenbergMarquardt minimizer;
  std::vector<std::size_t> places;  // linear ones first
  std::vector<double> constants;
  std::vector<double> searched;
  NormalEquations sums;
  std::vector<double> factor;
  std::vector<char> kept;
  std::vector<double> step;
  std::vector<double> cross;

  void choose_constants(const Expression& formula, FitExponents exponents);
  void put_linear_first(const Expression& formula);
  double plain_sum_squares();
  void solve_linear();
  double sum_squares(std::span<const double> x) override;
  void normal_equations(NormalEquations& result) override;
  bool may_go_on() const override { return !cut; }
};

void ConstantFitter::Workspace::choose_constants(const Expression& formula,
                                                 FitExponents exponents) {
  places.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!formula.node(i).is_constant()) continue;
    const bool is_held =
        is_exponent(formula, i) && exponents != FitExponents::all &&
        (exponents == FitExponents::none || is_simple_exponent(formula.node(i).value));
    if (!is_held) places.push_back(i);
  }
}

void ConstantFitter::Workspace::put_linear_first(const Expression& formula) {
  const std::vector<std::size_t> first = linear_constants(formula, places);
  linear = first.size();
  std::stable_partition(places.begin(), places.end(), [&](std::size_t place) {
    return std::ranges::binary_search(first, place);
  });
}

double ConstantFitter::Workspace::plain_sum_squares() {
  spent += pass_cost;
  differentiator.set_constants(constants);
  return differentiator.sum_squares(*inputs, target, weights, in_time);
}

// The linear constants' step to their best values, from the sums at hand: step = -A^-1 g.
void ConstantFitter::Workspace::solve_linear() {
  const std::size_t p = places.size();
  factor.resize(linear * linear);
  kept.resize(linear);
  step.resize(linear);
  for (std::size_t k = 0; k < linear; ++k) {
    for (std::size_t l = 0; l <= k; ++l) factor[k * linear + l] = sums.curvature[k * p + l];
  }
  cholesky_factor_semidefinite(factor, linear, kDependent, kept);
  for (std::size_t k = 0; k < linear; ++k) step[k] = kept[k] != 0 ? -sums.gradient[k] : 0;
  cholesky_solve(factor, linear, step);
}

double ConstantFitter::Workspace::sum_squares(std::span<const double> x) {
  std::ranges::copy(x, constants.begin() + static_cast<std::ptrdiff_t>(linear));
  if (linear == 0) return plain_sum_squares();
  spent += kPassWithSums * pass_cost;
  differentiator.set_constants(constants);
  differentiator.normal_equations(*inputs, target, weights, sums, in_time);
  if (!std::isfinite(sums.sum_squares)) return sums.sum_squares;
  solve_linear();
  double sum = sums.sum_squares;
  for (std::size_t k = 0; k < linear; ++k) sum += step[k] * sums.gradient[k];
  if (!std::isfinite(sum)) return std::numeric_limits<double>::quiet_NaN();
  if (sum > kCancelled * sums.sum_squares) return sum;
  const std::vector<double> before(constants.begin(),
                                   constants.begin() + static_cast<std::ptrdiff_t>(linear));
  for (std::size_t k = 0; k < linear; ++k) constants[k] += step[k];
  sum = plain_sum_squares();
  std::ranges::copy(before, constants.begin());
  return sum;
}

// At the linear constants that belong to the point evaluated last, with what they can follow taken
// out: J^T J - (L^-1 B^T J)^T (L^-1 B^T J).
void ConstantFitter::Workspace::normal_equations(NormalEquations& result) {
  spent += kPassWithSums * pass_cost;
  if (linear == 0) {
    differentiator.normal_equations(*inputs, target, weights, result, in_time);
    return;
  }
  for (std::size_t k = 0; k < linear; ++k) constants[k] += step[k];
  differentiator.set_constants(constants);
  differentiator.normal_equations(*inputs, target, weights, sums, in_time);
  const std::size_t p = places.size();
  const std::size_t q = p - linear;
  result.sum_squares = sums.sum_squares;
  result.gradient.resize(q);
  result.curvature.resize(q * q);
  if (!std::isfinite(sums.sum_squares)) {
    std::ranges::fill(result.gradient, sums.sum_squares);
    return;
  }
  solve_linear();
  cross.resize(q * linear);
  for (std::size_t k = 0; k < q; ++k) {
    const std::span<double> row = std::span(cross).subspan(k * linear, linear);
    result.gradient[k] = sums.gradient[linear + k];
    for (std::size_t i = 0; i < linear; ++i) {
      const double product = sums.curvature[(linear + k) * p + i];
      result.gradient[k] += product * step[i];
      row[i] = kept[i] != 0 ? product : 0;
    }
    cholesky_solve_lower(factor, linear, row);
    for (std::size_t l = 0; l <= k; ++l) {
      double left = sums.curvature[(linear + k) * p + linear + l];
      for (std::size_t i = 0; i < linear; ++i) left -= row[i] * cross[l * linear + i];
      if (k == l) left = std::max(left, 0.0);
      result.curvature[k * q + l] = left;
      result.curvature[l * q + k] = left;
    }
  }
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
  work.inputs = &inputs;
  work.target = target;
  work.weights = weights;
  work.pass_cost = node_rows(formula, inputs.rows);
  work.spent = 0;
  work.linear = 0;
  work.choose_constants(formula, options.exponents);
  if (options.low.empty() && options.high.empty()) work.put_linear_first(formula);
  work.constants.clear();
  for (std::size_t place : work.places) work.constants.push_back(formula.node(place).value);
  work.differentiator.prepare(formula, work.places);
  work.cut = false;
  work.in_time = {};
  if (options.in_time) {
    work.in_time = [&work, &options] {
      work.cut = work.cut || !options.in_time();
      return !work.cut;
    };
  }
  const double given = work.plain_sum_squares();
  ConstantFitResult result{work.cut ? FitStatus::out_of_time : FitStatus::not_finite, given, 0,
                           work.spent};
  if (!std::isfinite(given)) return result;
  if (work.places.empty()) {
    result.status = FitStatus::no_constants;
    return result;
  }
  work.searched.assign(work.constants.begin() + static_cast<std::ptrdiff_t>(work.linear),
                       work.constants.end());
  const LevenbergMarquardtResult fit = work.minimizer.minimize(
      work, work.searched,
      {options.max_iterations, options.gradient_tolerance, options.step_tolerance,
       options.function_tolerance, options.low, options.high});
  result.iterations = fit.iterations;
  result.status = fit.status == FitStatus::no_constants ? FitStatus::converged : fit.status;
  if (std::isfinite(work.sum_squares(work.searched)) && work.linear > 0) {
    for (std::size_t k = 0; k < work.linear; ++k) work.constants[k] += work.step[k];
  }
  const double reached = work.plain_sum_squares();
  result.node_rows = work.spent;
  if (work.cut) result.status = FitStatus::out_of_time;
  if (!(reached < given)) return result;
  result.sum_squares = reached;
  for (std::size_t k = 0; k < work.places.size(); ++k) {
    set_constant(formula, work.places[k], work.constants[k]);
  }
  return result;
}

}  // namespace tribench
