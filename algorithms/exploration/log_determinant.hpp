// SPDX-License-Identifier: MIT
//
// What a D-optimal plan makes large: the logarithm of the determinant of an information matrix.
#pragma once

#include <Eigen/Cholesky>

#include "foundation/elementary.hpp"

namespace tribench::loop {

// Of a symmetric, positive definite matrix; NaN where it is none.
inline double log_determinant(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  const Eigen::VectorXd diagonal = factor.matrixLLT().diagonal();
  double sum = 0;
  for (const double value : diagonal) sum += 2 * elementary::log(value);
  return sum;
}

}  // namespace tribench::loop
