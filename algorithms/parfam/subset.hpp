// SPDX-License-Identifier: MIT
//
// Polynomials by best subset: for each number of terms the monomials that explain most, by forward
// selection with exchanges until no exchange helps. Linear, so no starts and no local minima of
// the fit; the subset itself is best among all one-for-one exchanges.
//
// Source: Miller 2002, "Subset Selection in Regression", section 3.7 (sequential replacement).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench::parfam {

struct Subset {
  std::vector<std::size_t> chosen;  // increasing
  double sum_squares = 0;
};

// gram: of the candidates' columns and then y, (m + 1) x (m + 1). Best subsets of 1 .. max_terms
// columns; ends early where what is left is rounding. O(max_terms^3 m) per round of exchanges.
std::vector<Subset> best_subsets(std::span<const double> gram, std::size_t candidates,
                                 std::size_t max_terms);

}  // namespace tribench::parfam
