// SPDX-License-Identifier: MIT
#include "algorithms/fitting/separable_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"

namespace tribench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The problem in theta alone: coefficients follow theta.
class SeparableProjection : public LeastSquaresProblem {
 public:
  SeparableProjection(SeparableModel& model, std::span<const double> target,
                      const SeparableOptions& options)
      : model_(model),
        target_(target),
        options_(options),
        features_(model.features() * model.rows()),
        slopes_(model.parameters() * model.features() * model.rows()),
        residual_(model.rows()),
        jacobian_(model.parameters() * model.rows()) {}

  double sum_squares(std::span<const double> theta) override {
    theta_.assign(theta.begin(), theta.end());
    if (!model_.evaluate(theta, features_) || !solve()) return kInfinity;
    fitted(residual_);
    for (std::size_t r = 0; r < target_.size(); ++r) residual_[r] -= target_[r];
    const double sum = columns::dot(residual_.data(), residual_.data(), residual_.size());
    return std::isfinite(sum) ? sum : kInfinity;
  }

  // Kaufman: J_j = P (dF/dtheta_j) c, where P takes out what the active features can say.
  void normal_equations(NormalEquations& sums) override {
    const std::size_t p = model_.parameters();
    const std::size_t n = model_.rows();
    sums.gradient.assign(p, 0);
    sums.curvature.assign(p * p, 0);
    sums.sum_squares = columns::dot(residual_.data(), residual_.data(), n);
    if (!model_.differentiate(theta_, slopes_)) {
      sums.sum_squares = kInfinity;
      return;
    }
    for (std::size_t j = 0; j < p; ++j) {
      slope_of_fit(j, {jacobian_.data() + j * n, n});
      take_out_features({jacobian_.data() + j * n, n});
    }
    for (std::size_t i = 0; i < p; ++i) {
      const double* column = jacobian_.data() + i * n;
      sums.gradient[i] = columns::dot(column, residual_.data(), n);
      for (std::size_t j = 0; j <= i; ++j) {
        const double product = columns::dot(column, jacobian_.data() + j * n, n);
        sums.curvature[i * p + j] = product;
        sums.curvature[j * p + i] = product;
      }
    }
  }

  const std::vector<double>& coefficients() const { return coefficients_; }

 private:
  const double* feature(std::size_t k) const { return features_.data() + k * model_.rows(); }

  void fitted(std::span<double> out) const {
    std::vector<const double*> all;
    for (std::size_t k = 0; k < model_.features(); ++k) all.push_back(feature(k));
    columns::combine(all.data(), coefficients_.data(), all.size(), out.data(), out.size());
  }

  bool solve() {
    const std::size_t count = model_.features();
    std::vector<const double*> all;
    for (std::size_t k = 0; k < count; ++k) all.push_back(feature(k));
    gram_.resize(count * count);
    columns::gram(all.data(), count, model_.rows(), gram_.data());
    std::vector<double> with_target(count);
    for (std::size_t k = 0; k < count; ++k) {
      with_target[k] = columns::dot(all[k], target_.data(), target_.size());
    }
    const auto is_finite = [](double x) { return std::isfinite(x); };
    if (!std::ranges::all_of(gram_, is_finite) || !std::ranges::all_of(with_target, is_finite)) {
      return false;
    }
    coefficients_.assign(count, 0);
    return solve_quadratic(gram_, with_target, options_.non_negative, coefficients_);
  }

  // (dF/dtheta_j) c
  void slope_of_fit(std::size_t j, std::span<double> out) const {
    std::vector<const double*> slopes;
    const std::size_t count = model_.features();
    for (std::size_t k = 0; k < count; ++k) {
      slopes.push_back(slopes_.data() + (j * count + k) * model_.rows());
    }
    columns::combine(slopes.data(), coefficients_.data(), count, out.data(), out.size());
  }

  // A coefficient held at 0 says nothing: its feature stays out of the projection.
  void take_out_features(std::span<double> column) {
    const std::size_t count = model_.features();
    std::vector<std::size_t> active;
    for (std::size_t k = 0; k < count; ++k) {
      if (options_.non_negative[k] == 0 || coefficients_[k] > 0) active.push_back(k);
    }
    std::vector<double> gram;
    std::vector<double> with_column;
    std::vector<const double*> active_features;
    for (const std::size_t i : active) {
      for (const std::size_t j : active) gram.push_back(gram_[i * count + j]);
      with_column.push_back(columns::dot(feature(i), column.data(), column.size()));
      active_features.push_back(feature(i));
    }
    std::vector<double> share(active.size());
    const std::vector<char> free(active.size(), 0);
    if (active.empty() || !solve_quadratic(gram, with_column, free, share)) return;
    said_.resize(column.size());
    columns::combine(active_features.data(), share.data(), share.size(), said_.data(),
                     said_.size());
    for (std::size_t r = 0; r < column.size(); ++r) column[r] -= said_[r];
  }

  SeparableModel& model_;
  std::span<const double> target_;
  const SeparableOptions& options_;
  std::vector<double> theta_;
  std::vector<double> features_;
  std::vector<double> slopes_;
  std::vector<double> gram_;
  std::vector<double> coefficients_;
  std::vector<double> residual_;
  std::vector<double> jacobian_;
  std::vector<double> said_;
};

}  // namespace

SeparableFit fit_separable(SeparableModel& model, std::span<const double> target,
                           const SeparableOptions& options) {
  SeparableProjection projection(model, target, options);
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t s = 0; s < options.starts.size(); ++s) {
    ranked.emplace_back(projection.sum_squares(options.starts[s]), s);
  }
  std::ranges::sort(ranked);
  SeparableFit best;
  best.sum_squares = kInfinity;
  LevenbergMarquardt walker;
  LevenbergMarquardtOptions walk;
  walk.max_iterations = options.max_iterations;
  walk.function_tolerance = 1e-10;
  walk.low = options.low;
  walk.high = options.high;
  for (std::size_t k = 0; k < std::min(options.walked, ranked.size()); ++k) {
    if (!std::isfinite(ranked[k].first)) break;
    std::vector<double> theta = options.starts[ranked[k].second];
    if (!theta.empty()) walker.minimize(projection, theta, walk);
    const double value = projection.sum_squares(theta);
    if (!(value < best.sum_squares)) continue;
    best = {std::move(theta), projection.coefficients(), value};
  }
  return best;
}

}  // namespace tribench
