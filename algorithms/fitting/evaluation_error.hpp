// SPDX-License-Identifier: MIT
//
// How far what is computed for a formula may lie from its real value on given rows: terms that
// nearly cancel leave nothing but their rounding. 3e13 (x + 1e-13 - x) is a staircase in double
// precision, whatever it is on paper, and its stairs fit noise.
//
// A running bound row by row (expression/bounds.hpp): the truth is some times smaller.
#pragma once

#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// The largest bound of |computed - real| on at most 16 of the rows, spread evenly; infinite where
// nothing is known. Cost: nodes (4 + inputs) interval operations a row.
double largest_evaluation_error(const Expression& formula, const Inputs& inputs);

// Whether that is more than a millionth of the target's range: no such formula is worth choosing.
bool loses_its_digits(const Expression& formula, const Inputs& inputs,
                      std::span<const double> target);

}  // namespace tribench
