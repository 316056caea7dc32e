// SPDX-License-Identifier: MIT
//
// Laws that are one product of powers: of the inputs, of sines, exponentials and the like of one
// input, and of sums and differences of two. In logarithms that is a linear regression, solved at
// once and exactly; what is left tells whether it is the law.
//
// Finds nothing where there is noise: there an exact relation cannot be told from a good one, and
// the other searches weigh evidence. About 20 ms for 500 rows and five inputs.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Exact to rounding on the rows; none where no product is, or the budget does not allow to look.
std::optional<Expression> find_product(const LogRows& rows, const OperatorSet& operators,
                                       Budget& budget);

// Under noise, all the same to every row: the best products of every number of factors, to be
// fitted and weighed by the caller. Exponents near a multiple of a half are that.
std::vector<Expression> likely_products(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget);

}  // namespace tribench::relay
