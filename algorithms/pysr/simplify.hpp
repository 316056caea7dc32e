// SPDX-License-Identifier: MIT
//
// The simplification that runs inside the search, where it is done millions of times: constants
// are folded, constants met through one + or * are merged, what a 0 or a 1 makes pointless is
// dropped, common factors of summands are taken out and exponentials multiplied into one. Values
// change by rounding alone, and no domain shrinks or grows except where a factor 0 removes what it
// multiplies.
#pragma once

#include <cstdint>

#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

Expression simplified(const Expression& formula);

// A number that two formulas share when they differ at most in the values of their constants
// (exponents excepted) and in the order of the arguments of + and *. O(size).
std::uint64_t structure_hash(const Expression& formula);

}  // namespace tribench::pysr
