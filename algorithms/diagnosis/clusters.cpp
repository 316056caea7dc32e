// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tribench::loop {
namespace {

constexpr std::size_t kLongMovement = 45;
constexpr double kStretchRows = 30;
constexpr double kStretchTimes = 10;
constexpr int kFolds = 10;
constexpr int kFoldsOfOneMovement = 5;
// Beyond this the AR(1) formula would say that nothing is left to learn from.
constexpr double kLargestRho = 0.998;

std::vector<RowRange> movement_ranges(std::span<const int> movement) {
  std::vector<RowRange> ranges;
  for (std::size_t i = 0; i < movement.size(); ++i) {
    if (i == 0 || movement[i] != movement[i - 1]) ranges.push_back({i, i});
    ranges.back().end = i + 1;
  }
  return ranges;
}

void cut(Clusters& clusters, std::size_t m, double rows_per_stretch) {
  const RowRange range = clusters.movements[m];
  std::size_t pieces = 1;
  if (range.size() > kLongMovement) {
    pieces = std::max<std::size_t>(
        1, static_cast<std::size_t>(static_cast<double>(range.size()) / rows_per_stretch));
  }
  for (std::size_t k = 0; k < pieces; ++k) {
    clusters.stretches.push_back(
        {range.begin + range.size() * k / pieces, range.begin + range.size() * (k + 1) / pieces});
    clusters.movement_of.push_back(m);
  }
}

void assign_folds(Clusters& clusters, RandomStream random) {
  const std::size_t movements = clusters.movements.size();
  if (movements == 1) {
    const auto n = static_cast<int>(clusters.stretches.size());
    clusters.folds = std::min(kFoldsOfOneMovement, n);
    for (int c = 0; c < n; ++c) clusters.fold_of.push_back(c * clusters.folds / n);
    return;
  }
  clusters.folds = std::min(kFolds, static_cast<int>(movements));
  std::vector<std::size_t> order(movements);
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(std::span(order));
  std::vector<int> fold(movements);
  for (std::size_t i = 0; i < movements; ++i) {
    fold[order[i]] = static_cast<int>(i) % clusters.folds;
  }
  for (const std::size_t m : clusters.movement_of) clusters.fold_of.push_back(fold[m]);
}

// Sums over neighbours `lag` rows apart, within movements, of deviations from the movement's mean.
double autocovariance(const Eigen::VectorXd& deviation, std::span<const RowRange> movements,
                      std::size_t lag) {
  double sum = 0;
  for (const RowRange& m : movements) {
    if (m.size() <= lag) continue;
    const auto n = static_cast<Eigen::Index>(m.size() - lag);
    sum += deviation.segment(static_cast<Eigen::Index>(m.begin), n)
               .dot(deviation.segment(static_cast<Eigen::Index>(m.begin + lag), n));
  }
  return sum;
}

Eigen::VectorXd deviations(const Eigen::VectorXd& residual, std::span<const RowRange> movements) {
  Eigen::VectorXd out = residual;
  for (const RowRange& m : movements) {
    auto part =
        out.segment(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()));
    part.array() -= part.mean();
  }
  return out;
}

}  // namespace

Clusters make_clusters(std::span<const int> movement, double correlation_time,
                       RandomStream random) {
  Clusters clusters;
  clusters.rows = movement.size();
  clusters.movements = movement_ranges(movement);
  const double rows_per_stretch = std::max(kStretchRows, kStretchTimes * correlation_time);
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) cut(clusters, m, rows_per_stretch);
  assign_folds(clusters, random);
  return clusters;
}

Noise estimate_noise(const Eigen::VectorXd& residual, const Clusters& clusters, std::size_t fitted,
                     double floor_sd) {
  Noise noise;
  const auto movements = static_cast<double>(clusters.movements.size());
  const auto n = static_cast<double>(residual.size());
  const Eigen::VectorXd deviation = deviations(residual, clusters.movements);
  const double within = deviation.squaredNorm();
  const double dof = std::max(1.0, n - movements - static_cast<double>(fitted));
  noise.within_sd = std::max(std::sqrt(within / dof), floor_sd);
  if (within > 0) {
    noise.rho =
        std::clamp(autocovariance(deviation, clusters.movements, 1) / within, 0.0, kLargestRho);
  }
  noise.inflation = (1 + noise.rho) / (1 - noise.rho);
  const double variance = noise.within_sd * noise.within_sd;
  double means = 0;
  double expected = 0;
  for (const RowRange& m : clusters.movements) {
    const double mean =
        residual.segment(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()))
            .mean();
    const auto rows = static_cast<double>(m.size());
    means += mean * mean;
    expected += variance * std::min(noise.inflation, rows) / rows;
    noise.effective_rows += rows / std::min(noise.inflation, rows);
  }
  if (clusters.movements.size() > 2) {
    noise.between_sd = std::sqrt(std::max(0.0, (means - expected) / movements));
  }
  return noise;
}

double quasi_demeaning(const Noise& noise, std::size_t rows) {
  const double variance = noise.within_sd * noise.within_sd;
  const auto n = static_cast<double>(rows);
  const double between = n * noise.between_sd * noise.between_sd;
  return 1 - std::sqrt(variance / (variance * std::min(noise.inflation, n) + between));
}

Eigen::MatrixXd whitened(const Eigen::MatrixXd& columns, const Clusters& clusters,
                         const Noise& noise) {
  Eigen::MatrixXd out = columns;
  for (const RowRange& m : clusters.movements) {
    const double theta = quasi_demeaning(noise, m.size());
    auto block =
        out.middleRows(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()));
    const Eigen::RowVectorXd shift = theta * block.colwise().mean();
    block.rowwise() -= shift;
  }
  return out;
}

double correlation_time(const Eigen::VectorXd& residual, std::span<const RowRange> movements) {
  constexpr double kFaded = 0.05;
  const Eigen::VectorXd deviation = deviations(residual, movements);
  const double variance = deviation.squaredNorm();
  if (!(variance > 0)) return 1;
  std::size_t longest = 0;
  for (const RowRange& m : movements) longest = std::max(longest, m.size());
  double sum = 0;
  double first = 0;
  for (std::size_t lag = 1; lag < longest; ++lag) {
    const double rho = autocovariance(deviation, movements, lag) / variance;
    if (lag == 1) first = std::clamp(rho, 0.0, kLargestRho);
    if (rho < kFaded) break;
    sum += rho;
  }
  return std::max({1.0, first > 0 ? -1 / std::log(first) : 0.0, sum});
}

}  // namespace tribench::loop
