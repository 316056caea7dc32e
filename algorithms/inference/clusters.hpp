// SPDX-License-Identifier: MIT
//
// Which rows are independent of which: movements, the stretches they are cut into (the clusters
// of every test) and the folds of cross-validation, which never cut a movement unless there is but
// one. Also the noise within and between them, and the transform that takes it out of the way.
//
// Source: random-intercept quasi-demeaning (Fuller and Battese 1973) after pre-whitening of
// neighbouring rows (Prais and Winsten 1954); effective sizes as in the specification, section 3.1
// to 3.3, whose optional whitening and weights by movement are the rule here. We differ in that the
// intercept belongs to the movement, not to the stretch: stretches of one movement share their
// offset.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {

struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

// The rows of each movement: runs of equal numbers.
std::vector<RowRange> movement_ranges(std::span<const int> movement);

struct Clusters {
  std::vector<RowRange> movements;
  std::vector<RowRange> stretches;
  std::vector<std::size_t> movement_of;  // per stretch
  std::vector<int> fold_of;              // per stretch
  int folds = 0;
  std::size_t rows = 0;
  // Per movement: its rows count as if their noise were 1/weight times the usual; empty: all 1.
  std::vector<double> weight;
  double weight_of(std::size_t movement) const { return weight.empty() ? 1 : weight[movement]; }
};

// Stretches hold at least 30 rows and 10 correlation times (in rows); a shorter movement is one
// stretch. Ten folds of movements in turn, fewer where there are fewer movements; five folds
// of neighbouring stretches where there is one movement.
Clusters make_clusters(std::span<const int> movement, double correlation_time);

struct Noise {
  double within_sd = 0;   // sw
  double between_sd = 0;  // sb, of the movements' offsets
  double rho = 0;         // correlation of neighbouring rows within a movement
  double inflation = 1;   // (1 + rho) / (1 - rho)
  double effective_rows = 0;

  // Each row less this share of the one before it is what tests and fits look at: rho, or 0 where
  // that cannot be trusted (see Search::fit).
  double whitening = 0;
  // Variance of such a row, and how much its long-run variance exceeds it (1 where whitening is
  // rho).
  double row_variance() const {
    return within_sd * within_sd * (1 + whitening * (whitening - 2 * rho));
  }
  double row_inflation() const {
    const double w = whitening;
    return inflation * (1 - w) * (1 - w) / (1 + w * (w - 2 * rho));
  }
  // What a squared whitened error counts, in nats.
  double unit() const { return 2 * row_variance() * row_inflation(); }
};

// From residuals; `fitted` parameters are taken off the degrees of freedom. floor_sd keeps the
// noise of perfect data from vanishing.
Noise estimate_noise(const Eigen::VectorXd& residual, const Clusters& clusters, std::size_t fitted,
                     double floor_sd);

// Rows less `whitening` times the row before, movement by movement; then the part along a
// movement's offset shrunk by what is known of offsets; then the movement's weight. Noise of the
// columns comes out with row_variance(), uncorrelated.
Eigen::MatrixXd whitened(Eigen::MatrixXd columns, const Clusters& clusters, const Noise& noise);
// A movement's offset in whitened rows, before they are weighed: `first` in its first row, `next`
// in the others. The part of the rows along it is shrunk to the share `kept`.
struct OffsetDirection {
  double first;
  double next;
  double length;  // squared
  double noise;   // variance along it, without the offset's own
  double offset;  // the offset's own
  double kept;
};
OffsetDirection offset_direction(const Clusters& clusters, std::size_t m, const Noise& noise);

// ln of what the offsets add to the spread of each movement's mean, halved and shared out to its
// stretches: the part of a negative log likelihood that says how well offsets are explained.
Eigen::VectorXd offset_nats(const Clusters& clusters, const Noise& noise);

// Weights of the movements from their own noise in `residual`: the spread of the movements' log
// variances that sampling does not explain is kept, the rest is shrunk away. Mean square 1.
std::vector<double> movement_weights(const Eigen::VectorXd& residual, const Clusters& clusters);

// In rows: the larger of -1/log(rho) and the sum of the autocorrelations before they fall below
// 0.05, pooled over the movements.
double correlation_time(const Eigen::VectorXd& residual, std::span<const RowRange> movements);

}  // namespace tribench::loop
