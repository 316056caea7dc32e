// SPDX-License-Identifier: MIT
//
// Which constants of a formula a fit may move: all but integer exponents, which are part of its
// form; and which exponents are numbers that a fit has found. Not for a search over forms.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// Places of the tape, increasing. O(nodes).
std::vector<std::size_t> free_constants(const Expression& formula);

// A multiple of a half or of a third: such exponents are of laws, others were fitted.
bool is_simple_exponent(double exponent);

// How many exponents of the formula are not simple: numbers, which evidence_price does not count.
std::size_t free_exponents(const Expression& formula);

// The nearest of those: 0.5 for 0.49, 2/3 for 0.67.
double nearest_simple_exponent(double exponent);

}  // namespace tribench
