// SPDX-License-Identifier: MIT
//
// Which columns of a linear regression the target asks for: backward elimination from all of them,
// as long as the extended Bayesian information criterion falls, with a price of log n + 2 log p a
// column. Exact columns of an exact sum are found, too: what is left counts from rounding on.
//
// Not for as many columns as rows, nor for hundreds of them: O(rows p^2 + p^4).
// Source: Chen and Chen 2008, Extended Bayesian information criteria, with gamma = 1.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tribench {

// The kept columns in increasing order. Of columns that depend on one another (to rounding) some
// are kept. All values must be finite. At least one column is kept, unless all are 0.
std::vector<Eigen::Index> backward_elimination(Eigen::MatrixXd columns,
                                               const Eigen::VectorXd& target);

}  // namespace tribench
