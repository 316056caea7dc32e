// SPDX-License-Identifier: MIT
//
// The noise within and between movements, told from the residuals of a fit.
//
// Within a movement it is a slow part, which falls by the same factor from row to row, and a white
// one (an autoregression seen through white noise, ARMA(1,1)): that form stays what it is however
// many rows a second a logger has written, which the autoregression alone does not. Each movement
// has an offset of its own besides (a random intercept). Not for noise that swings.
//
// Residuals are finite, in any unit.
//
// Source: Granger and Morris 1976 (sums of autoregressions); Schwarz 1978 (the price of the white
// part); Fuller and Battese 1973 (random intercept).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"

namespace tribench::loop {

struct Noise {
  double within_sd = 0;   // sw
  double between_sd = 0;  // sb, of the movements' offsets
  double slow_share = 0;  // of the variance within a movement: what lasts; the rest is white
  double slow_rho = 0;    // correlation of the slow part in neighbouring rows
  double effective_rows = 0;
  // Whether tests and fits look at rows less what the rows before foretell, or at rows as they are,
  // where that cannot be trusted (fit_in_its_noise).
  bool whitened = false;

  // A random intercept is noise, whatever its size. But nobody expects it to be most of what is
  // left.
  bool is_mostly_between() const { return between_sd > within_sd; }
  // Correlation of neighbouring rows within a movement.
  double rho() const { return slow_share * slow_rho; }
  // By how much less rows tell of a mean than independent ones.
  double inflation() const { return 1 + 2 * rho() / (1 - slow_rho); }

  // Variance of a row as it is looked at, and how much its long-run variance exceeds it.
  double row_variance() const;
  double row_inflation() const { return whitened ? 1 : inflation(); }
  // What a squared error of such a row counts, in nats.
  double unit() const { return 2 * row_variance() * row_inflation(); }
};

// From residuals; `fitted` parameters are taken off the degrees of freedom. floor_sd keeps the
// noise of perfect data from vanishing. Cost: some 65 products a row.
Noise estimate_noise(const Eigen::VectorXd& residual, const Clusters& clusters, std::size_t fitted,
                     double floor_sd);

// sb from the means of the movements' rows, beyond what the noise within movements makes of them;
// 0 where there are no more than two movements.
double offset_spread(const Eigen::VectorXd& means, const Clusters& clusters, const Noise& noise);

// Weights of the movements from their own noise in `residual`: the spread of the movements' log
// variances that sampling does not explain is kept, the rest is shrunk away. Mean square 1.
std::vector<double> movement_weights(const Eigen::VectorXd& residual, const Clusters& clusters);

// In rows: the larger of -1/log(rho) and the sum of the autocorrelations before they fall below
// 0.05, pooled over the movements.
double correlation_time(const Eigen::VectorXd& residual, std::span<const RowRange> movements);

}  // namespace tribench::loop
