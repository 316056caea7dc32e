// SPDX-License-Identifier: MIT
#include "algorithms/inference/canonical_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/score_test.hpp"

namespace tribench::loop {

double canonical_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd qa = orthonormal_basis(a);
  const Eigen::MatrixXd qb = orthonormal_basis(b);
  if (qa.cols() == 0 || qb.cols() == 0) return 0;
  const Eigen::MatrixXd cross = cross_products(qa, qb);
  const Eigen::MatrixXd gram = cross.transpose() * cross;
  return std::sqrt(std::min(1.0, spectral_norm_symmetric(gram)));
}

}  // namespace tribench::loop
