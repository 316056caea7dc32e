// SPDX-License-Identifier: MIT
//
// Which rows are independent of which: movements, the stretches they are cut into (the clusters
// of every test) and the folds of cross-validation, which never cut a movement unless there is but
// one. Also the noise within and between them, and the transform that takes it out of the way.
//
// Source: random-intercept quasi-demeaning (Fuller and Battese 1973); effective sizes as in the
// specification, section 3.1 to 3.3. We differ in that the intercept belongs to the movement, not
// to the stretch: stretches of one movement share their offset.
#pragma once

#include <Eigen/Core>
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

struct Clusters {
  std::vector<RowRange> movements;
  std::vector<RowRange> stretches;
  std::vector<std::size_t> movement_of;  // per stretch
  std::vector<int> fold_of;              // per stretch
  int folds = 0;
  std::size_t rows = 0;
};

// Stretches hold at least 30 rows and 10 correlation times (in rows); a movement of up to 45 rows
// is one stretch. Ten folds of movements, fewer where there are fewer movements; five folds of
// neighbouring stretches where there is one movement.
Clusters make_clusters(std::span<const int> movement, double correlation_time, RandomStream random);

struct Noise {
  double within_sd = 0;   // sw
  double between_sd = 0;  // sb, of the movements' offsets
  double rho = 0;         // correlation of neighbouring rows within a movement
  double inflation = 1;   // (1 + rho) / (1 - rho)
  double effective_rows = 0;
};

// From residuals; `fitted` parameters are taken off the degrees of freedom. floor_sd keeps the
// noise of perfect data from vanishing.
Noise estimate_noise(const Eigen::VectorXd& residual, const Clusters& clusters, std::size_t fitted,
                     double floor_sd);

// theta of a movement of n rows: a column's mean over the movement, times theta, is taken off.
double quasi_demeaning(const Noise& noise, std::size_t rows);
Eigen::MatrixXd whitened(const Eigen::MatrixXd& columns, const Clusters& clusters,
                         const Noise& noise);

// In rows: the larger of -1/log(rho) and the sum of the autocorrelations before they fall below
// 0.05, pooled over the movements.
double correlation_time(const Eigen::VectorXd& residual, std::span<const RowRange> movements);

}  // namespace tribench::loop
