// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/shaking.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "algorithms/inference/score_test.hpp"
#include "foundation/sign.hpp"

namespace tribench::loop {
namespace {

// Of either mean: drives reach what they are told within a quarter of a second, and what shakes
// them more slowly hardly moves them.
constexpr double kHalfWindow_s = 0.125;
constexpr double kLeastShare = 0.5;
constexpr double kErrors = 2;

bool is_shaken(const Signal& signal) {
  return signal.role == Role::acceleration || signal.is_late();
}

// Means over the rows of the movement within half a window on either side.
std::vector<double> window_means(std::span<const double> values, std::span<const double> time,
                                 const std::vector<RowRange>& movements) {
  std::vector<double> means(values.size());
  for (const RowRange& rows : movements) {
    std::size_t first = rows.begin;
    std::size_t end = rows.begin;
    double sum = 0;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      while (end < rows.end && time[end] <= time[i] + kHalfWindow_s) sum += values[end++];
      while (time[first] < time[i] - kHalfWindow_s) sum -= values[first++];
      means[i] = sum / static_cast<double>(end - first);
    }
  }
  return means;
}

// The rows with a velocity and accelerations that nothing shakes.
Observations smooth_motion(const Campaign& campaign) {
  Observations smooth = campaign.data;
  const std::vector<RowRange>& movements = campaign.clusters.movements;
  const auto smoothed = [&](const std::vector<double>& values) {
    return window_means(window_means(values, smooth.time, movements), smooth.time, movements);
  };
  for (Signal& signal : smooth.signals) {
    if (signal.role == Role::velocity || is_shaken(signal)) signal.values = smoothed(signal.values);
  }
  const Signal* v = smooth.find("v");
  for (Signal& signal : smooth.signals) {
    if (signal.role != Role::velocity_sign || v == nullptr) continue;
    for (std::size_t i = 0; i < smooth.rows(); ++i) signal.values[i] = sign(v->values[i]);
  }
  return smooth;
}

// What is linear in the model, the family's columns taken together behind the others.
Eigen::MatrixXd regressors(const LoopModel& model, std::size_t family, const Observations& data) {
  std::vector<Expression> rest = model.base.linear_terms;
  for (const Atom& atom : model.atoms) {
    if (atom.family == family) continue;
    rest.insert(rest.end(), atom.columns.begin(), atom.columns.end());
  }
  return beside(evaluate_columns(rest, data), contribution(model, family, data));
}

// A factor on the family's torque and its standard error, by stretches.
struct Factor {
  double value = 0;
  double error = 0;
};

// Of the last of the regressors, all of them by instruments of their own.
Factor instrumented_factor(const Eigen::MatrixXd& x, const Eigen::MatrixXd& instruments,
                           const Eigen::VectorXd& y, const Clusters& clusters) {
  const Eigen::Index last = x.cols() - 1;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> system(instruments.transpose() * x);
  const Eigen::VectorXd theta = system.solve(instruments.transpose() * y);
  const Eigen::VectorXd left = y - x * theta;
  // Of the inverse the last row alone is asked for.
  const Eigen::VectorXd row = system.pseudoInverse().row(last).transpose();
  const Eigen::VectorXd influence = (instruments * row).cwiseProduct(left);
  double squares = 0;
  for (const RowRange& rows : clusters.stretches) {
    const double sum =
        influence
            .segment(static_cast<Eigen::Index>(rows.begin), static_cast<Eigen::Index>(rows.size()))
            .sum();
    squares += sum * sum;
  }
  return {theta[last], std::sqrt(squares)};
}

}  // namespace

bool goes_with_shaking(const FittedModel& fit, std::size_t family, const Campaign& campaign) {
  const Observations& data = campaign.data;
  // Late velocities are there where time is in s, whether the movements' order counts or not.
  const bool is_timed = std::ranges::any_of(data.signals, &Signal::is_late);
  const std::vector<const Signal*> read = signals_read(fit.model, family, data);
  const bool is_asked = is_timed && campaign.options.has("shaking") &&
                        std::ranges::any_of(read, [](const Signal* s) { return is_shaken(*s); });
  if (!is_asked) return false;
  const LoopModel& model = fit.model;
  const Eigen::MatrixXd x = regressors(model, family, data);
  const Eigen::VectorXd y =
      fit.raw_residual + evaluate_columns(linear_columns(model), data) * model.coefficients;
  const Factor share = instrumented_factor(x, regressors(model, family, smooth_motion(campaign)), y,
                                           campaign.clusters);
  return !(share.value - kErrors * share.error >= kLeastShare);
}

}  // namespace tribench::loop
