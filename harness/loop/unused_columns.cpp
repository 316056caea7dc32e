// SPDX-License-Identifier: MIT
#include "harness/loop/unused_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "harness/loop/noise_bounds.hpp"

namespace tribench::loop {
namespace {

constexpr int kTurns = 5;
constexpr double kWorthSaying = 0.05;  // of the error
constexpr double kStandardErrors = 3;  // over the movements, so that thirty columns stay silent
constexpr std::size_t kFewestMovements = 5;

// The column alone, as a temperature: an input of unknown sense.
Observations alone(const Observations& data, const Signal& column) {
  Observations out;
  out.target = data.target;
  out.movement = data.movement;
  out.signals.push_back({"T", column.channel, column.unit, Role::none, {}, column.values});
  if (const Signal* direction = data.find("sgn_v")) out.signals.push_back(*direction);
  return out;
}

// Per row, without its movement.
Eigen::VectorXd predicted(const Observations& column, const std::vector<int>& turn,
                          const Eigen::VectorXd& residual, const RandomStream& random) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(residual.size());
  for (int k = 0; k < kTurns; ++k) {
    std::vector<char> train(turn.size());
    for (std::size_t i = 0; i < turn.size(); ++i) train[i] = turn[i] != k ? 1 : 0;
    const Eigen::VectorXd whole = smooth_correction(column, train, residual, random);
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      if (train[static_cast<std::size_t>(i)] == 0) out[i] = whole[i];
    }
  }
  return out;
}

}  // namespace

std::vector<UnusedColumn> unused_columns_that_explain(const Observations& data,
                                                      const Eigen::VectorXd& residual,
                                                      const RandomStream& random) {
  std::map<int, std::size_t> place;  // of a movement's number, in the order of the rows
  for (const int m : data.movement) place.try_emplace(m, place.size());
  const std::size_t movements = place.size();
  if (movements < kFewestMovements) return {};
  std::vector<int> turn;
  for (const int m : data.movement) turn.push_back(static_cast<int>(place.at(m)) % kTurns);
  std::vector<UnusedColumn> telling;
  for (const Signal& column : data.unused) {
    const Eigen::VectorXd correction = predicted(alone(data, column), turn, residual, random);
    std::vector<double> less(movements, 0);
    for (std::size_t i = 0; i < data.rows(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      less[place.at(data.movement[i])] +=
          std::abs(residual[at]) - std::abs(residual[at] - correction[at]);
    }
    const Eigen::Map<const Eigen::ArrayXd> gains(less.data(), static_cast<Eigen::Index>(movements));
    const double n = static_cast<double>(movements);
    const double error = std::sqrt((gains - gains.mean()).square().sum() / (n * (n - 1)));
    const double share = gains.sum() / residual.cwiseAbs().sum();
    if (share >= kWorthSaying && gains.mean() > kStandardErrors * error) {
      telling.push_back({column.channel, share});
    }
  }
  std::ranges::stable_sort(
      telling, [](const UnusedColumn& a, const UnusedColumn& b) { return a.share > b.share; });
  return telling;
}

}  // namespace tribench::loop
