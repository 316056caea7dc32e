// SPDX-License-Identifier: MIT
#include "harness/loop/loop_judge.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "algorithms/inference/bootstrap.hpp"
#include "algorithms/loop_model/loop_model.hpp"

namespace tribench::loop {
namespace {

// Mean errors of runs of rows with equal numbers.
std::vector<MovementError> mean_errors(std::span<const int> run, const Eigen::VectorXd& before,
                                       const Eigen::VectorXd& after) {
  std::vector<MovementError> all;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i == 0 || run[i] != run[i - 1]) all.push_back({.movement = run[i]});
    const double one = before[static_cast<Eigen::Index>(i)];
    const double other = after[static_cast<Eigen::Index>(i)];
    all.back().before += std::abs(one);
    all.back().after += std::abs(other);
    all.back().mean_before += one;
    all.back().mean_after += other;
    ++all.back().rows;
  }
  for (MovementError& one : all) {
    const auto rows = static_cast<double>(one.rows);
    one.before /= rows;
    one.after /= rows;
    one.mean_before /= rows;
    one.mean_after /= rows;
  }
  return all;
}

double root_mean_square(const std::vector<MovementError>& all, double MovementError::*error) {
  double sum = 0;
  for (const MovementError& one : all) sum += one.*error * (one.*error);
  return std::sqrt(sum / static_cast<double>(all.size()));
}

}  // namespace

ErrorFinding judge(const Observations& data, const Eigen::VectorXd& before,
                   const Eigen::VectorXd& after, std::span<const int> unit, RandomStream random) {
  ErrorFinding out;
  if (data.rows() == 0) return out;
  const Eigen::VectorXd error_before = target_vector(data) - before;
  const Eigen::VectorXd error_after = target_vector(data) - after;
  const auto n = static_cast<double>(data.rows());
  out.mae_before = error_before.cwiseAbs().mean();
  out.mae_after = error_after.cwiseAbs().mean();
  out.rmse_before = error_before.norm() / std::sqrt(n);
  out.rmse_after = error_after.norm() / std::sqrt(n);
  out.max_before = error_before.cwiseAbs().maxCoeff();
  out.max_after = error_after.cwiseAbs().maxCoeff();
  out.movements = mean_errors(data.movement, error_before, error_after);
  out.test_movements = out.movements.size();
  out.means_before = root_mean_square(out.movements, &MovementError::mean_before);
  out.means_after = root_mean_square(out.movements, &MovementError::mean_after);
  const std::vector<MovementError> units = mean_errors(unit, error_before, error_after);
  std::tie(out.difference_low, out.difference_high) =
      bootstrap_interval(units.size(), random, [&](const std::vector<std::size_t>& drawn) {
        double sum = 0;
        for (const std::size_t k : drawn) sum += units[k].before - units[k].after;
        return sum / static_cast<double>(units.size());
      });
  return out;
}

}  // namespace tribench::loop
