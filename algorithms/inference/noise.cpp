// SPDX-License-Identifier: MIT
#include "algorithms/inference/noise.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

// Beyond this the formula would say that nothing is left to learn from.
constexpr double kLargestRho = 0.998;
constexpr std::size_t kFewestForWeights = 10;
// The white part is told from rows this far apart, on a grid fine enough for any use of it.
constexpr std::size_t kLags = 64;
constexpr int kMemories = 20;

auto rows_of(const Eigen::VectorXd& column, const RowRange& range) {
  return column.segment(static_cast<Eigen::Index>(range.begin),
                        static_cast<Eigen::Index>(range.size()));
}

auto rows_of(Eigen::VectorXd& column, const RowRange& range) {
  return column.segment(static_cast<Eigen::Index>(range.begin),
                        static_cast<Eigen::Index>(range.size()));
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

// How rows are foretold: `carried` of the row before less `returned` of what that row's own
// forecast missed, that is a mean of all rows before whose weights fall by `returned` each.
struct Forecast {
  double carried = 0;
  double returned = 0;
  double variance = 1;  // of what it misses, over that of the rows
};

// The best forecast with this memory, told from the autocorrelations (the first is 1).
Forecast best_forecast(std::span<const double> correlation, double returned) {
  double shared = 0;  // of a row with the mean of those before
  double power = 1;
  for (std::size_t k = 1; k < correlation.size(); ++k) {
    shared += power * correlation[k];
    power *= returned;
  }
  const double square = (1 + 2 * returned * shared) / (1 - returned * returned);
  const double weight = square > 0 ? std::clamp(shared / square, 0.0, kLargestRho - returned) : 0;
  return {weight + returned, returned, 1 - weight * (2 * shared - weight * square)};
}

// Sets the noise's slow part to what foretells the rows best. A white part beside it has to be
// worth the price of a parameter more than a slow part alone has, and of two more than none.
void estimate_memory(const Eigen::VectorXd& deviation, const Clusters& clusters, Noise& noise) {
  const double squares = deviation.squaredNorm();
  if (!(squares > 0)) return;
  std::vector<double> correlation = {1};
  while (correlation.size() <= kLags) {
    correlation.push_back(autocovariance(deviation, clusters.movements, correlation.size()) /
                          squares);
  }
  const Forecast slow = best_forecast(correlation, 0);
  Forecast best = slow;
  for (int k = 1; k < kMemories; ++k) {
    const Forecast one = best_forecast(correlation, static_cast<double>(k) / kMemories);
    if (one.variance < best.variance) best = one;
  }
  const auto n = static_cast<double>(deviation.size());
  const double price = elementary::log(n) / n;
  const double without = std::min(0.0, elementary::log(slow.variance) + price);
  if (elementary::log(best.variance) + 2 * price > without) best = slow;
  const double phi = best.carried;
  const double theta = best.returned;
  noise.slow_rho = phi;
  noise.slow_share =
      phi > 0 ? (1 - phi * theta) * (phi - theta) / ((1 + theta * (theta - 2 * phi)) * phi) : 0;
}

Eigen::VectorXd deviations(const Eigen::VectorXd& residual, std::span<const RowRange> movements) {
  Eigen::VectorXd out = residual;
  for (const RowRange& m : movements) {
    auto part = rows_of(out, m);
    part.array() -= part.mean();
  }
  return out;
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
  // Squares of normal rows are correlated by the square.
  const double slow = noise.slow_rho * noise.slow_rho;
  const double inflation = 1 + 2 * noise.rho() * noise.rho() / (1 - slow);
  const double kurtosis = deviation.array().square().square().mean() / (variance * variance);
  LogVariances logs;
  for (const RowRange& range : clusters.movements) {
    const auto n = static_cast<double>(range.size());
    const double squares = rows_of(deviation, range).squaredNorm();
    // One row has no deviation and says nothing of how loud its movement is.
    const double part = range.size() > 1 ? squares / (n - 1) / variance : 1;
    logs.values.push_back(elementary::log(std::max(part, 1e-6)));
    logs.mean += logs.values.back() / count;
    logs.sampling += (kurtosis - 1) * inflation / n / count;
  }
  return logs;
}

}  // namespace

double Noise::row_variance() const {
  const double variance = within_sd * within_sd;
  if (!whitened) return variance;
  // Of the slow part in the next row, when all rows before are known.
  const double white = 1 - slow_share;
  const double fresh = slow_share * (1 - slow_rho * slow_rho);
  const double half = 0.5 * (white * (1 - slow_rho * slow_rho) - fresh);
  return variance * (std::sqrt(half * half + fresh * white) - half + white);
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
  estimate_memory(deviation, clusters, noise);
  Eigen::VectorXd means(static_cast<Eigen::Index>(clusters.movements.size()));
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    const auto rows = static_cast<double>(clusters.movements[m].size());
    means[static_cast<Eigen::Index>(m)] = rows_of(residual, clusters.movements[m]).mean();
    noise.effective_rows += rows / std::min(noise.inflation(), rows);
  }
  noise.between_sd = offset_spread(means, clusters, noise);
  return noise;
}

double offset_spread(const Eigen::VectorXd& means, const Clusters& clusters, const Noise& noise) {
  if (means.size() <= 2) return 0;
  const double variance = noise.within_sd * noise.within_sd;
  double expected = 0;
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    const auto rows = static_cast<double>(clusters.movements[m].size());
    const double own = variance / (clusters.weight_of(m) * clusters.weight_of(m));
    expected += own * std::min(noise.inflation(), rows) / rows;
  }
  const double more = means.squaredNorm() - expected;
  return std::sqrt(std::max(0.0, more / static_cast<double>(means.size())));
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
