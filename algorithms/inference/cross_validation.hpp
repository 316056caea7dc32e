// SPDX-License-Identifier: MIT
//
// How much better a model predicts movements it was not fitted to: losses by cluster from grouped
// cross-validation on whitened columns, and paired comparisons of two models.
//
// Source: specification, sections 3.6 and 3.7 (a paired comparison as Vuong 1989).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/noise.hpp"

namespace tribench::loop {

// Per cluster: sum of squared held-out errors over the noise's unit, in nats. x: rows x columns,
// y: rows, both whitened. Columns that depend on others are harmless.
// Cost: rows x columns^2, and one small factorisation a fold.
// NaN where a column is excited by one fold alone, which then has no prediction; with a ridge such
// a column has no weight there. ridge: on the last `penalised` columns, relative to their sums of
// squares.
Eigen::VectorXd held_out_losses(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Clusters& clusters, const Noise& noise,
                                Eigen::Index penalised = 0, double ridge = 0);

struct Gain {
  double nats = 0;
  double error = 0;  // standard error over the clusters
};

// What the second model gains over the first.
Gain paired_gain(const Eigen::VectorXd& losses_before, const Eigen::VectorXd& losses_after);

}  // namespace tribench::loop
