// SPDX-License-Identifier: MIT
#include "algorithms/pysr/denoise.hpp"

#include <Eigen/Core>
#include <cmath>

#include "algorithms/fitting/gaussian_process.hpp"

namespace tribench::pysr {
namespace {

constexpr int kRestarts = 50;

Eigen::MatrixXd points_of(const Rows& rows, std::span<const std::size_t> columns) {
  Eigen::MatrixXd points(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const std::vector<double>& column = rows.columns[columns[j]];
    points.col(static_cast<Eigen::Index>(j)) =
        Eigen::Map<const Eigen::VectorXd>(column.data(), points.rows());
  }
  return points;
}

Eigen::VectorXd target_of(const Rows& rows) {
  return Eigen::Map<const Eigen::VectorXd>(rows.target.data(),
                                           static_cast<Eigen::Index>(rows.size()));
}

}  // namespace

std::optional<Denoised> denoised(const Rows& measured, const Rows& wanted,
                                 std::span<const std::size_t> columns, RandomStream random,
                                 Budget& budget) {
  const Rows training = draw_sample(measured, kTrainingRows, random);
  const Rows few = draw_sample(training, kCovarianceRows, random);
  const std::uint64_t n = training.size();
  const std::uint64_t m = few.size();
  if (columns.empty() || m < 2) return std::nullopt;
  // A likelihood and its gradient take as long as m^3 / 2 node-rows.
  const std::uint64_t cost =
      most_likelihoods(kRestarts) * m * m * m / 2 + n * n * n / 6 + n * wanted.size();
  if (cost > budget.remaining() || !budget.spend(cost)) return std::nullopt;
  const Standardisation inputs(points_of(training, columns));
  const Standardisation output(target_of(training));
  const auto outputs = [&](const Rows& rows) -> Eigen::VectorXd {
    return output.rows(target_of(rows));
  };
  const Covariance likely = most_likely_covariance(
      inputs.rows(points_of(few, columns)), outputs(few), kRestarts, random.split("restarts"));
  const auto scaled = [&](const Rows& rows) -> Eigen::MatrixXd {
    return inputs.rows(points_of(rows, columns)).array().rowwise() /
           likely.lengths.transpose().array();
  };
  GaussianProcess process;
  if (!process.train(scaled(training), outputs(training), 1, likely.noise, likely.constant)) {
    return std::nullopt;
  }
  Denoised result;
  result.noise = std::sqrt(likely.noise * process.variance()) * output.spread[0];
  const Eigen::MatrixXd points = scaled(wanted);
  for (Eigen::Index r = 0; r < points.rows(); ++r) {
    result.target.push_back(output.center[0] +
                            output.spread[0] * process.mean_at(points.row(r).transpose()));
  }
  return result;
}

}  // namespace tribench::pysr
