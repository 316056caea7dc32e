// SPDX-License-Identifier: MIT
//
// Cholesky factors of small symmetric matrices, in place and without allocation: the solves inside
// every damped step and every projection. For more than some fifty unknowns use Eigen.
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

// Factor of a Gram matrix that may be singular: a column whose part that is new is no more than
// `tolerance` of its square is left out; its row and column of the factor are those of the unit
// matrix, so that solving gives it what the right-hand side has there (set that to 0 by `kept`).
inline void cholesky_factor_semidefinite(std::span<double> matrix, std::size_t p, double tolerance,
                                         std::span<char> kept) {
  for (std::size_t i = 0; i < p; ++i) {
    const double square = matrix[i * p + i];
    double diagonal = square;
    for (std::size_t j = 0; j < i; ++j) {
      double entry = matrix[i * p + j];
      for (std::size_t k = 0; k < j; ++k) entry -= matrix[i * p + k] * matrix[j * p + k];
      matrix[i * p + j] = kept[j] != 0 ? entry / matrix[j * p + j] : 0;
      diagonal -= matrix[i * p + j] * matrix[i * p + j];
    }
    kept[i] = diagonal > tolerance * square ? 1 : 0;
    matrix[i * p + i] = kept[i] != 0 ? std::sqrt(diagonal) : 1;
    if (kept[i] != 0) continue;
    for (std::size_t j = 0; j < i; ++j) matrix[i * p + j] = 0;
  }
}

// Solves L x = rhs in place.
inline void cholesky_solve_lower(std::span<const double> factor, std::size_t p,
                                 std::span<double> rhs) {
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t k = 0; k < i; ++k) rhs[i] -= factor[i * p + k] * rhs[k];
    rhs[i] /= factor[i * p + i];
  }
}

// Solves L^T x = rhs in place.
inline void cholesky_solve_upper(std::span<const double> factor, std::size_t p,
                                 std::span<double> rhs) {
  for (std::size_t i = p; i-- > 0;) {
    for (std::size_t k = i + 1; k < p; ++k) rhs[i] -= factor[k * p + i] * rhs[k];
    rhs[i] /= factor[i * p + i];
  }
}

// Solves L L^T x = rhs in place.
inline void cholesky_solve(std::span<const double> factor, std::size_t p, std::span<double> rhs) {
  cholesky_solve_lower(factor, p, rhs);
  cholesky_solve_upper(factor, p, rhs);
}

}  // namespace tribench
