// SPDX-License-Identifier: MIT
//
// How nearly two groups of columns say the same. Not a test: what chance would give is larger the
// more columns there are.
//
// Source: Hotelling 1936, Relations between two sets of variates, the first of his correlations.
#pragma once

#include <Eigen/Core>

namespace tribench::loop {

// The largest correlation of any combination of a's columns (n x p) with any of b's (n x q), in
// [0, 1]; no mean is taken off. 0 where one of them has no column but zeros. Finite columns. The
// same whatever regular combinations of the columns are given. O(n (p^2 + q^2)).
double canonical_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace tribench::loop
