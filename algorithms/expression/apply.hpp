// SPDX-License-Identifier: MIT
//
// One operation on one number or two: what folding constants and walking along a tape need. The
// same bits as the evaluator, whose kernels do it; some 5 ns a call. Not for rows: see
// evaluate.hpp.
//
// NaN policy: as the evaluator; log of a negative number is NaN.
#pragma once

#include "algorithms/expression/expression.hpp"

namespace tribench {

double apply(Op function, double a);             // neg .. atan
double apply(Op operation, double a, double b);  // + - * / ^, a whole exponent as a product

}  // namespace tribench
