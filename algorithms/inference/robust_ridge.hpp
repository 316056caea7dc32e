// SPDX-License-Identifier: MIT
//
// What is left of rows beside more columns than anybody would report: for the noise's own laws,
// before it is known which columns belong there. Not for coefficients that are read: a ridge
// shrinks them.
//
// Source: Hoerl and Kennard 1970 (the ridge), Huber 1964 (the weights), of which one step is taken.
#pragma once

#include <Eigen/Core>
#include <span>

namespace tribench::loop {

// y - x c of every row, c fitted to the rows `train` with a ridge of 1e-4 of the mean square of a
// column there; rows beyond two standard deviations weigh the less the farther they lie, so that
// a burst does not bend the fit. x: n x p, y: n, finite. Columns are scaled to length 1 first; one
// of zeros, or with a number that is not finite, gets no weight. O(n p^2).
Eigen::VectorXd robust_ridge_residual(Eigen::MatrixXd x, const Eigen::VectorXd& y,
                                      std::span<const Eigen::Index> train);

}  // namespace tribench::loop
