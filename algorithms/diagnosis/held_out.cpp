// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "algorithms/inference/bootstrap.hpp"
#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

// The strata of the split: movements in one direction or in both, by speed.
struct Kind {
  int movement;
  bool one_way;
  double speed;
};

std::vector<Kind> kinds(const Observations& data) {
  const Signal* v = data.find("v");
  std::vector<Kind> all;
  std::size_t i = 0;
  for (const int m : data.movements()) {
    double sum = 0;
    double magnitude = 0;
    const std::size_t begin = i;
    for (; i < data.rows() && data.movement[i] == m; ++i) {
      sum += v == nullptr ? 0 : v->values[i];
      magnitude += v == nullptr ? 0 : std::abs(v->values[i]);
    }
    const bool one_way = std::abs(sum) > 0.9 * magnitude;
    all.push_back({m, one_way, magnitude / static_cast<double>(i - begin)});
  }
  return all;
}

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

std::vector<int> choose_test_movements(const Observations& data, double share) {
  std::vector<Kind> all = kinds(canonical(data).data);
  const auto wanted =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(all.size())));
  if (share <= 0 || all.size() < 2) return {};
  std::ranges::stable_sort(all, [](const Kind& a, const Kind& b) {
    return a.one_way != b.one_way ? b.one_way
                                  : static_cast<float>(a.speed) < static_cast<float>(b.speed);
  });
  // The middle one of every run of neighbours, so that every speed is held out alike.
  const std::size_t count = std::max<std::size_t>(1, wanted);
  std::vector<int> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = all.size() * k / count;
    const std::size_t end = all.size() * (k + 1) / count;
    chosen.push_back(all[(begin + end) / 2].movement);
  }
  std::ranges::sort(chosen);
  return chosen;
}

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
