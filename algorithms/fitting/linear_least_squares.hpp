// SPDX-License-Identifier: MIT
//
// Linear least squares, exactly: rank-aware QR without a ridge, and the same with some
// coefficients held non-negative. Not for many columns that nearly depend on one another: nothing
// is shrunk, and their coefficients are as large as the rows ask for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

struct LinearFit {
  std::vector<double> coefficients;
  double sum_squares = 0;
  int rank = 0;
  // Of the design with columns scaled to unit length: how well the coefficients are determined,
  // whatever their units. Infinite where the rank is deficient.
  double condition = 1;
};

// Minimises sum_r (sum_k c_k columns[k][r] - target[r])^2. Where columns depend on one another
// (to 1e-10 of the largest), those that add nothing get coefficient 0. All values must be finite.
// O(rows p^2).
LinearFit solve_least_squares(std::span<const double* const> columns,
                              std::span<const double> target);

// A quadratic c^T A c / 2 - b^T c over c with c_k >= 0 for the k with non_negative[k] != 0.
// A (p x p, row by row) must be positive semidefinite; directions it does not determine are left
// at 0. Exact: all active sets are tried where the free minimum is not feasible, so few
// coefficients (at most 12) may be held. Returns false where no active set gives finite numbers.
bool solve_quadratic(std::span<const double> a, std::span<const double> b,
                     std::span<const char> non_negative, std::span<double> solution);

}  // namespace tribench
