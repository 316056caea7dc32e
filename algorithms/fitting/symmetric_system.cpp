// SPDX-License-Identifier: MIT
#include "algorithms/fitting/symmetric_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace tribench {

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.ldlt().solve(b);
}

Eigen::MatrixXd inverse_symmetric(const Eigen::MatrixXd& a) {
  return a.ldlt().solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

double spectral_norm_symmetric(const Eigen::MatrixXd& a) {
  return a.selfadjointView<Eigen::Lower>().operatorNorm();
}

}  // namespace tribench
