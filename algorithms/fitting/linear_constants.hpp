// SPDX-License-Identifier: MIT
//
// Which constants of a formula enter linearly, all of them together: for given values of the
// others they are the solution of a linear least-squares problem. Not for constants that enter
// linearly one at a time: a and b of a * b do, but not together.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// The places, among those given (constants of the tape, increasing), of a largest such set that
// sums, products with what holds none of it, and numerators pass on: in (a x + b) exp(c x) these
// are a and b; of a * b the left one where both sides have as many. O(nodes).
std::vector<std::size_t> linear_constants(const Expression& formula,
                                          std::span<const std::size_t> places);

}  // namespace tribench
