// SPDX-License-Identifier: MIT
//
// Dense linear least squares by Eigen's Householder QR with column pivots, which sees what columns
// depend on others; for tall matrices of a handful to some hundreds of columns. Not for sparse
// ones, and nothing is scaled: bring columns to like lengths first where their units differ. All
// values must be finite. x has at least one row and one column. O(n p^2).
//
// One place, since every file that instantiates the factorisation compiles it again, four seconds
// each.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace tribench {

class PivotedQr {
 public:
  // x (n x p). A pivot of at most `threshold` of the largest counts as 0; by default that is what
  // rounding leaves, the machine's precision times the smaller of n and p.
  explicit PivotedQr(const Eigen::MatrixXd& x);
  PivotedQr(const Eigen::MatrixXd& x, double threshold);

  // Columns that do not follow from the others.
  Eigen::Index rank() const;
  // c with the least |x c - y|; columns that add nothing get 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& y) const;
  // The same for each column of y.
  Eigen::MatrixXd solve_each(const Eigen::MatrixXd& y) const;
  // n x rank: an orthonormal base of what x's columns span.
  Eigen::MatrixXd basis() const;
  // The largest singular value of x over the smallest; infinite where the rank is deficient.
  double condition() const;

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace tribench
