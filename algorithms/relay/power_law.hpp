// SPDX-License-Identifier: MIT
//
// Power laws under noise that adds to the target: y = c prod_j x_j^p_j, nearest to the target in
// its own units (a generalised linear model with a logarithmic link, Nelder and Wedderburn 1972),
// so that targets which noise has made small, or turned the sign of, mislead nobody.
//
// Not for exact data, and not for products of more than inputs: product_search.hpp. Not the last
// word either: the caller weighs them by their evidence.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// One power law of each number of inputs, from all of them down to one, the input that matters
// least left out each time; and of each the same with every exponent that the rows cannot tell from
// a multiple of a half being that. Inputs with a value of 0, and what the operators do not allow,
// are left out; nothing where no input is left, or more than 15. O(rows p^4) of p inputs.
std::vector<Expression> likely_power_laws(const LogRows& rows, const OperatorSet& operators,
                                          Budget& budget);

// The rows as a regression of logarithms that looks at errors of the target itself: columns times
// `weights` explain `response`.
struct LinkedRows {
  std::vector<double> weights;
  std::vector<double> response;
};

// log |y|, as sure as y is large: right where noise is smaller than most of the target.
LinkedRows rows_by_size(const LogRows& rows);

// Linearised at the power law of all inputs: right where that is near, however small the target.
std::optional<LinkedRows> rows_by_power_law(const LogRows& rows, Budget& budget);

}  // namespace tribench::relay
