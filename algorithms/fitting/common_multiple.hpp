// SPDX-License-Identifier: MIT
//
// What a fit leaves open: k (a + b x) is the same for every k that a and b are divided by, and so
// is k sqrt(a + b x). Of all of them the one is wanted whose numbers have names (named_values.hpp):
// 0.487 sqrt(1.054 + 8.433 x^2) is sqrt(1 + 8 x^2) / 2.
#pragma once

#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// The formula with one of its sums divided by a number after which all numbers of the sum have a
// name or are next to nothing, and the number written before it, through roots and powers; one
// formula for every such sum and number. The same function to rounding; longer by the number, until
// it is merged with what stands beside it. Cost: O(nodes) a sum and number.
std::vector<Expression> with_common_multiple_out(const Expression& formula);

}  // namespace tribench
