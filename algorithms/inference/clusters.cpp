// SPDX-License-Identifier: MIT
#include "algorithms/inference/clusters.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kStretchRows = 30;
constexpr double kStretchTimes = 10;
constexpr int kFolds = 10;
constexpr int kFoldsOfOneMovement = 5;
// Beyond this the AR(1) formula would say that nothing is left to learn from.
constexpr double kLargestRho = 0.998;
constexpr std::size_t kFewestForWeights = 10;

auto rows_of(const Eigen::VectorXd& column, const RowRange& range) {
  return column.segment(static_cast<Eigen::Index>(range.begin),
                        static_cast<Eigen::Index>(range.size()));
}

auto rows_of(Eigen::VectorXd& column, const RowRange& range) {
  return column.segment(static_cast<Eigen::Index>(range.begin),
                        static_cast<Eigen::Index>(range.size()));
}

void cut(Clusters& clusters, std::size_t m, double rows_per_stretch) {
  const RowRange range = clusters.movements[m];
  const auto pieces = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(range.size()) / rows_per_stretch));
  for (std::size_t k = 0; k < pieces; ++k) {
    clusters.stretches.push_back(
        {range.begin + range.size() * k / pieces, range.begin + range.size() * (k + 1) / pieces});
    clusters.movement_of.push_back(m);
  }
}

void assign_folds(Clusters& clusters) {
  const std::size_t movements = clusters.movements.size();
  if (movements == 1) {
    const auto n = static_cast<int>(clusters.stretches.size());
    clusters.folds = std::min(kFoldsOfOneMovement, n);
    for (int c = 0; c < n; ++c) clusters.fold_of.push_back(c * clusters.folds / n);
    return;
  }
  clusters.folds = std::min(kFolds, static_cast<int>(movements));
  for (const std::size_t m : clusters.movement_of) {
    clusters.fold_of.push_back(static_cast<int>(m) % clusters.folds);
  }
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
    auto part = rows_of(out, m);
    part.array() -= part.mean();
  }
  return out;
}

// Adds to the noise what differs between movements beyond the noise within them.
void estimate_offsets(const Eigen::VectorXd& residual, const Clusters& clusters, Noise& noise) {
  const double variance = noise.within_sd * noise.within_sd;
  double means = 0;
  double expected = 0;
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    const double mean = rows_of(residual, clusters.movements[m]).mean();
    const auto rows = static_cast<double>(clusters.movements[m].size());
    const double own = variance / (clusters.weight_of(m) * clusters.weight_of(m));
    means += mean * mean;
    expected += own * std::min(noise.inflation, rows) / rows;
    noise.effective_rows += rows / std::min(noise.inflation, rows);
  }
  if (clusters.movements.size() <= 2) return;
  const auto movements = static_cast<double>(clusters.movements.size());
  noise.between_sd = std::sqrt(std::max(0.0, (means - expected) / movements));
}

// Of the movements' variances, over that of all; `sampling` is the variance that such logarithms
// have of themselves.
struct LogVariances {
  std::vector<double> values;
  double mean = 0;
  double sampling = 0;
};

LogVariances log_variances(const Eigen::VectorXd& residual, const Clusters& clusters,
                           const Noise& noise) {
  const auto count = static_cast<double>(clusters.movements.size());
  const Eigen::VectorXd deviation = deviations(residual, clusters.movements);
  const double variance = noise.within_sd * noise.within_sd;
  // Of squares of an AR(1): they are correlated by rho^2.
  const double square = noise.rho * noise.rho;
  const double kurtosis = deviation.array().square().square().mean() / (variance * variance);
  LogVariances logs;
  for (const RowRange& range : clusters.movements) {
    const auto n = static_cast<double>(range.size());
    const double squares = rows_of(deviation, range).squaredNorm();
    logs.values.push_back(
        elementary::log(std::max(squares / std::max(1.0, n - 1) / variance, 1e-6)));
    logs.mean += logs.values.back() / count;
    logs.sampling += (kurtosis - 1) * (1 + square) / (1 - square) / n / count;
  }
  return logs;
}

}  // namespace

std::vector<RowRange> movement_ranges(std::span<const int> movement) {
  std::vector<RowRange> ranges;
  for (std::size_t i = 0; i < movement.size(); ++i) {
    if (i == 0 || movement[i] != movement[i - 1]) ranges.push_back({i, i});
    ranges.back().end = i + 1;
  }
  return ranges;
}

Clusters make_clusters(std::span<const int> movement, double correlation_time) {
  Clusters clusters;
  clusters.rows = movement.size();
  clusters.movements = movement_ranges(movement);
  const double rows_per_stretch = std::max(kStretchRows, kStretchTimes * correlation_time);
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) cut(clusters, m, rows_per_stretch);
  assign_folds(clusters);
  return clusters;
}

Noise estimate_noise(const Eigen::VectorXd& residual, const Clusters& clusters, std::size_t fitted,
                     double floor_sd) {
  Noise noise;
  const auto movements = static_cast<double>(clusters.movements.size());
  const auto n = static_cast<double>(residual.size());
  Eigen::VectorXd deviation = deviations(residual, clusters.movements);
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    rows_of(deviation, clusters.movements[m]) *= clusters.weight_of(m);
  }
  const double within = deviation.squaredNorm();
  const double dof = std::max(1.0, n - movements - static_cast<double>(fitted));
  noise.within_sd = std::max(std::sqrt(within / dof), floor_sd);
  if (within > 0) {
    noise.rho =
        std::clamp(autocovariance(deviation, clusters.movements, 1) / within, 0.0, kLargestRho);
  }
  noise.inflation = (1 + noise.rho) / (1 - noise.rho);
  estimate_offsets(residual, clusters, noise);
  return noise;
}

OffsetDirection offset_direction(const Clusters& clusters, std::size_t m, const Noise& noise) {
  OffsetDirection u;
  u.first = std::sqrt(noise.row_variance()) / noise.within_sd;
  u.next = 1 - noise.whitening;
  u.length =
      u.first * u.first + static_cast<double>(clusters.movements[m].size() - 1) * u.next * u.next;
  u.noise = noise.row_variance() *
            std::min(noise.row_inflation(), static_cast<double>(clusters.movements[m].size()));
  const double between = noise.between_sd * clusters.weight_of(m);
  u.offset = between * between * u.length;
  u.kept = std::sqrt(noise.row_variance() / (u.noise + u.offset));
  return u;
}

Eigen::MatrixXd whitened(Eigen::MatrixXd columns, const Clusters& clusters, const Noise& noise) {
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    const RowRange& range = clusters.movements[m];
    auto block = columns.middleRows(static_cast<Eigen::Index>(range.begin),
                                    static_cast<Eigen::Index>(range.size()));
    const OffsetDirection u = offset_direction(clusters, m, noise);
    const auto rows = block.rows();
    for (Eigen::Index j = 0; j < block.cols(); ++j) {
      double* column = block.col(j).data();
      // Backwards, so that each row finds the one before as it was.
      for (Eigen::Index i = rows - 1; i > 0; --i) column[i] -= noise.whitening * column[i - 1];
      column[0] *= u.first;
      const auto rest = block.col(j).tail(rows - 1);
      const double shift = (1 - u.kept) * (u.first * column[0] + u.next * rest.sum()) / u.length;
      column[0] -= shift * u.first;
      block.col(j).tail(rows - 1).array() -= shift * u.next;
    }
    const double weight = clusters.weight_of(m);
    if (weight != 1) block *= weight;
  }
  return columns;
}

Eigen::VectorXd offset_nats(const Clusters& clusters, const Noise& noise) {
  std::vector<double> stretches(clusters.movements.size(), 0.0);
  for (const std::size_t m : clusters.movement_of) ++stretches[m];
  Eigen::VectorXd nats(static_cast<Eigen::Index>(clusters.stretches.size()));
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    const std::size_t m = clusters.movement_of[c];
    const OffsetDirection u = offset_direction(clusters, m, noise);
    nats[static_cast<Eigen::Index>(c)] = 0.5 * elementary::log1p(u.offset / u.noise) / stretches[m];
  }
  return nats;
}

std::vector<double> movement_weights(const Eigen::VectorXd& residual, const Clusters& clusters) {
  const std::size_t count = clusters.movements.size();
  std::vector<double> weights(count, 1.0);
  if (count < kFewestForWeights) return weights;
  const Noise noise = estimate_noise(residual, clusters, 0, 0);
  if (!(noise.within_sd * noise.within_sd > 0)) return weights;
  const LogVariances logs = log_variances(residual, clusters, noise);
  double spread = 0;
  for (const double x : logs.values) {
    spread += (x - logs.mean) * (x - logs.mean) / static_cast<double>(count - 1);
  }
  const double kept = spread > 0 ? std::clamp(1 - logs.sampling / spread, 0.0, 1.0) : 0.0;
  double squares = 0;
  for (std::size_t m = 0; m < count; ++m) {
    weights[m] = elementary::exp(-0.5 * kept * (logs.values[m] - logs.mean));
    squares += weights[m] * weights[m] / static_cast<double>(count);
  }
  for (double& w : weights) w /= std::sqrt(squares);
  return weights;
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
  return std::max({1.0, first > 0 ? -1 / elementary::log(first) : 0.0, sum});
}

}  // namespace tribench::loop
