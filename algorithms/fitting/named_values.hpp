// SPDX-License-Identifier: MIT
//
// Numbers that formulas are written with: whole ones, small fractions, small multiples of pi, e,
// ln 2, ln 10 and roots, and decimals of at most six digits that are all but met.
#pragma once

#include <vector>

namespace tribench {

inline constexpr double kNearNamed = 1e-3;  // of the value

// Those near c, the simplest first; 0 is none of them.
std::vector<double> named_values(double c);

}  // namespace tribench
