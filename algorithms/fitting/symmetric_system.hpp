// SPDX-License-Identifier: MIT
//
// Dense systems with a symmetric matrix, by Eigen's LDL^T and QL. For a handful to some hundreds of
// unknowns; not for sparse ones. Only the lower triangle is read. A singular matrix gives numbers
// that mean nothing, or NaN: load the diagonal where that can be. O(p^3).
//
// One place, since every file that instantiates a factorisation compiles it again, three seconds
// each.
#pragma once

#include <Eigen/Core>

namespace tribench {

// x of a x = b; a (p x p) positive or negative semidefinite.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

Eigen::MatrixXd inverse_symmetric(const Eigen::MatrixXd& a);

// A minimiser of |y - x c| from x'x and x'y, one a column of b: columns of x that depend on others
// get no weight (pivots below `threshold` of the largest, so scale x's columns to like lengths
// first). Negated columns give negated weights, bit for bit.
Eigen::MatrixXd basic_solution_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                         double threshold);

// x times a matrix that makes its columns orthonormal, those that depend on others left out (as
// above, of columns scaled to unit length). Source: Yamamoto et al. 2015 (CholeskyQR2).
Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& x, double threshold);

// a vectors.col(k) = values[k] vectors.col(k); the smallest value first, the vectors orthonormal.
struct EigenParts {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
EigenParts eigen_parts_symmetric(const Eigen::MatrixXd& a);

// The largest magnitude of an eigenvalue.
double spectral_norm_symmetric(const Eigen::MatrixXd& a);

}  // namespace tribench
