// SPDX-License-Identifier: MIT
//
// A formula as it is written: 170 - 3*x where a search has made 170 + -3*x. Values are the same bit
// for bit, nodes as many or (of a sign alone) fewer; constants change their signs.
//
// Not a canonical form (canonical.hpp): sums keep their shape but for the order of two terms.
#pragma once

#include "algorithms/expression/expression.hpp"

namespace tribench {

// Adds what would be a difference of negative numbers, and subtracts what would be added negative.
// O(nodes * depth).
Expression with_differences(const Expression& formula);

}  // namespace tribench
