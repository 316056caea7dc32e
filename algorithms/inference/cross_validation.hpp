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

// Gram matrices of [x y], one a stretch: all that held-out losses need. x: rows x columns, y: rows,
// both whitened.
// Cost: rows x columns^2.
using StretchGrams = std::vector<Eigen::MatrixXd>;
StretchGrams stretch_grams(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                           const Clusters& clusters);
// Those of [x more y], where those of [x y] are known: what candidates beside one model share is
// multiplied once. Cost: rows x more columns x all columns.
StretchGrams with_columns(const StretchGrams& grams, const Eigen::MatrixXd& x,
                          const Eigen::VectorXd& y, const Eigen::MatrixXd& more,
                          const Clusters& clusters);

// The coefficients of x that fit all stretches best.
Eigen::VectorXd coefficients_of(const StretchGrams& grams);

// Per cluster: sum of squared held-out errors over the noise's unit, in nats. Columns that depend
// on others are harmless.
// Cost: one small factorisation a fold.
// NaN where a column is excited by one fold alone, which then has no prediction; with a ridge such
// a column has no weight there. ridge: on the last `penalised` columns, relative to their sums of
// squares.
Eigen::VectorXd held_out_losses(const StretchGrams& grams, const Clusters& clusters,
                                const Noise& noise, Eigen::Index penalised = 0, double ridge = 0);
Eigen::VectorXd held_out_losses(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Clusters& clusters, const Noise& noise,
                                Eigen::Index penalised = 0, double ridge = 0);

// So much a cluster counts for at most in Gain::bounded_z.
inline constexpr double kMostOfOneCluster = 12;  // nats

struct Gain {
  double nats = 0;
  double error = 0;  // standard error over the clusters
  // How many standard errors it is where no cluster counts for more than kMostOfOneCluster either
  // way: of a sum that a few clusters make, those few are the error, too.
  double bounded_z = 0;
};

// What the second model gains over the first.
Gain paired_gain(const Eigen::VectorXd& losses_before, const Eigen::VectorXd& losses_after);

}  // namespace tribench::loop
