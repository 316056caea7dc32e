// SPDX-License-Identifier: MIT
//
// Laws that are a short sum of products of powers, of the target itself, of a power or the
// logarithm of it, or a ratio of two such sums:
//
//   T(y) = sum_k c_k P_k(x)   or, for y and log y,   T(y) = sum_k c_k P_k(x) + d T(y) Q(x),
//   P, Q = (cosine, difference, ...) prod x_i^a_i
//
// with T one of y, y^2, 1/y, 1/y^2, log y (there powers of the inputs as factors besides). All
// products of small whole exponents are columns of one regression, relative to the size of each
// row's target, so that rows of all decades count alike; all pairs of columns are tried, the best
// pairs grown term by term, in one Gram matrix.
//
// Finds nothing where there is noise (product_search.hpp says why).
// Cost: with `most` columns most^2 / 16 nodes a row and T; 0.1 s for 500 columns and rows.
#pragma once

#include <optional>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// With square roots of inputs and of products of two; with factors.hpp's waves, sums, differences.
enum class Columns { powers_alone, with_roots, with_factors };

// The shortest sum that is exact to rounding on the rows, of at most `most` columns; none where
// none is, or the budget is spent.
std::optional<Expression> find_relation(const LogRows& rows, const OperatorSet& operators,
                                        Columns columns, std::size_t most, Budget& budget);

// Under noise, all the same to every row: the best sums and ratios of two and three terms for every
// T, to be fitted and weighed by the caller. Fewer columns are more here, as the best of many sums
// fits noise.
std::vector<Expression> likely_relations(const LogRows& rows, const OperatorSet& operators,
                                         Columns columns, std::size_t most, Budget& budget);

// One root of a quadratic equation, y^2 = d y Q(x) + sum_k c_k P_k(x): what is left of a balance
// where y stands in two places (a height of fall, a crank, an equilibrium). The columns as above,
// at the cost of one T.
std::optional<Expression> find_root(const LogRows& rows, const OperatorSet& operators,
                                    Columns columns, std::size_t most, Budget& budget);

}  // namespace tribench::relay
