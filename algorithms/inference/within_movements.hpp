// SPDX-License-Identifier: MIT
//
// Whether a column says something beyond what may differ from movement to movement anyway. Tests
// whose clusters are stretches of movements take these for independent of each other; where every
// movement has coefficients of its own, they are not, and of few movements some slow signal is by
// chance always like what differs between them. Two tests do without: what the column says within
// movements (fixed effects), and what whole movements say of it, whose signs are flipped together.
//
// Not for finding anything: each asks one column, and what truly follows a slow signal may show in
// one of them only.
//
// Source: Frisch and Waugh 1933 (both sides less the fit of what is not asked for); Mundlak 1978
// (within and between); Cameron, Gelbach and Miller 2008 (few clusters).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/flips.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// The columns less, in each movement, their least-squares fit by its rows of `terms`. Cost: rows x
// terms x columns.
Eigen::MatrixXd within_movements(Eigen::MatrixXd columns, const Eigen::MatrixXd& terms,
                                 std::span<const RowRange> movements);

// A column beside a model: all whitened, residual of that model, its columns as they are.
struct AskedColumn {
  Eigen::VectorXd column;
  Eigen::MatrixXd model;
  Eigen::VectorXd residual;
};

// The p of a score test by flips of the clusters where each movement has these terms of its own.
// 1 where less than a thousandth of the column is within movements.
double p_within_movements(const AskedColumn& asked, const Eigen::MatrixXd& terms,
                          const Clusters& clusters, const Flips& flips);

// The p of a score test by `flips` flips of whole movements: of n at least 2^(1 - n).
double p_of_movements(const AskedColumn& asked, const Clusters& clusters, std::size_t flips,
                      RandomStream random);

}  // namespace tribench::loop
