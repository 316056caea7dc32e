// SPDX-License-Identifier: MIT
//
// How far the computed value of one operation may lie from its real one: what the errors of its
// operands become, and what its own rounding adds. Operands and results are ranges that hold the
// computed values; errors are magnitudes, infinite where nothing is known. Internal to the room.
#pragma once

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"

namespace tribench {

struct Operand {
  Interval range;
  double error = 0;  // |computed - real|
};

// |f(a) - f(a')| for the real operands and the computed ones; `result` is the operation's range.
double operand_error(Op op, const Operand& a, const Interval& result);
double operand_error(Op op, const Operand& a, const Operand& b, const Interval& result);

// What the operation itself errs by. b is the last operand (the only one of a function); of binary
// ones `same` says that both are the same formula: x + x and x - x are exact.
double rounding_error_of(Op op, const Interval& a, const Interval& b, bool same,
                         const Interval& result);

}  // namespace tribench
