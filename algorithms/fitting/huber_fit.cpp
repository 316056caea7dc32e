// SPDX-License-Identifier: MIT
#include "algorithms/fitting/huber_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tribench {
namespace {

constexpr double kEfficient = 1.345;       // Holland & Welsch 1977
constexpr double kMadOfGaussian = 0.6745;  // median |r| of unit Gaussian noise

double loss_of(std::span<const double> residuals, double threshold) {
  double loss = 0;
  for (double r : residuals) {
    const double size = std::abs(r);
    loss += size <= threshold ? 0.5 * r * r : threshold * (size - 0.5 * threshold);
  }
  return loss;
}

double median_magnitude(std::vector<double> residuals) {
  for (double& r : residuals) r = std::abs(r);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::ranges::nth_element(residuals, middle);
  return *middle;
}

}  // namespace

HuberFitResult fit_huber(ConstantFitter& fitter, Expression& formula, const Inputs& inputs,
                         std::span<const double> target, const HuberFitOptions& options) {
  HuberFitResult result;
  Evaluator evaluator;
  std::vector<double> residuals(target.size());
  std::vector<double> weights(target.size());
  const auto update = [&](const Expression& at) {
    evaluator.evaluate(at, inputs, residuals);
    for (std::size_t r = 0; r < target.size(); ++r) residuals[r] -= target[r];
    result.node_rows += node_rows(at, inputs.rows);
  };
  update(formula);
  if (target.empty() || !std::isfinite(loss_of(residuals, 1))) {
    result.status = FitStatus::not_finite;
    return result;
  }
  result.threshold = options.threshold > 0
                         ? options.threshold
                         : kEfficient * median_magnitude(residuals) / kMadOfGaussian;
  result.loss = loss_of(residuals, result.threshold);
  result.status = FitStatus::max_iterations;
  if (result.threshold == 0) {
    result.status = FitStatus::converged;  // half of the residuals are 0 already
    return result;
  }
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t r = 0; r < target.size(); ++r) {
      const double size = std::abs(residuals[r]);
      weights[r] = size <= result.threshold ? 1 : result.threshold / size;
    }
    Expression trial = formula;
    const ConstantFitResult fit = fitter.fit(trial, inputs, target, weights, options.fit);
    result.node_rows += fit.node_rows;
    if (fit.status == FitStatus::no_constants || fit.status == FitStatus::not_finite) {
      result.status = fit.status;
      return result;
    }
    update(trial);
    const double loss = loss_of(residuals, result.threshold);
    const bool settled = !(loss < result.loss * (1 - options.tolerance));
    if (loss < result.loss) {
      formula = std::move(trial);
      result.loss = loss;
    }
    if (settled) {
      result.status = FitStatus::converged;
      return result;
    }
  }
  return result;
}

}  // namespace tribench
