// SPDX-License-Identifier: MIT
//
// Cholesky factor of a small symmetric positive definite matrix, in place and without allocation:
// the solve inside every damped step. For more than some fifty unknowns use Eigen.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tribench {

// Overwrites the lower triangle of the p x p matrix (row by row) with its factor L. False, with
// the matrix spoilt, where it is not positive definite to rounding or not finite.
inline bool cholesky_factor(std::span<double> matrix, std::size_t p) {
  for (std::size_t j = 0; j < p; ++j) {
    double diagonal = matrix[j * p + j];
    for (std::size_t k = 0; k < j; ++k) diagonal -= matrix[j * p + k] * matrix[j * p + k];
    if (!(diagonal > 0) || !std::isfinite(diagonal)) return false;
    const double root = std::sqrt(diagonal);
    matrix[j * p + j] = root;
    for (std::size_t i = j + 1; i < p; ++i) {
      double entry = matrix[i * p + j];
      for (std::size_t k = 0; k < j; ++k) entry -= matrix[i * p + k] * matrix[j * p + k];
      matrix[i * p + j] = entry / root;
    }
  }
  return true;
}

// Solves L L^T x = rhs in place.
inline void cholesky_solve(std::span<const double> factor, std::size_t p, std::span<double> rhs) {
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t k = 0; k < i; ++k) rhs[i] -= factor[i * p + k] * rhs[k];
    rhs[i] /= factor[i * p + i];
  }
  for (std::size_t i = p; i-- > 0;) {
    for (std::size_t k = i + 1; k < p; ++k) rhs[i] -= factor[k * p + i] * rhs[k];
    rhs[i] /= factor[i * p + i];
  }
}

}  // namespace tribench
