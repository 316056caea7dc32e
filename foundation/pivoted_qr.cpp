// SPDX-License-Identifier: MIT
#include "foundation/pivoted_qr.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace tribench {

PivotedQr::PivotedQr(const Eigen::MatrixXd& x) : qr_(x) {}

PivotedQr::PivotedQr(const Eigen::MatrixXd& x, double threshold) {
  qr_.setThreshold(threshold);
  qr_.compute(x);
}

Eigen::Index PivotedQr::rank() const { return qr_.rank(); }

Eigen::VectorXd PivotedQr::solve(const Eigen::VectorXd& y) const { return qr_.solve(y); }

Eigen::MatrixXd PivotedQr::solve_each(const Eigen::MatrixXd& y) const { return qr_.solve(y); }

Eigen::MatrixXd PivotedQr::basis() const {
  return qr_.householderQ() * Eigen::MatrixXd::Identity(qr_.rows(), rank());
}

double PivotedQr::condition() const {
  if (rank() < qr_.cols()) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd triangle =
      qr_.matrixR().topRows(std::min(qr_.rows(), qr_.cols())).triangularView<Eigen::Upper>();
  const Eigen::VectorXd singular = triangle.jacobiSvd().singularValues();
  return singular.maxCoeff() / singular.minCoeff();
}

}  // namespace tribench
