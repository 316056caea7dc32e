// SPDX-License-Identifier: MIT
//
// The simplest equal formula we know on a box: the canonical form (canonical.hpp) with x - x, 0 x,
// x^0 and x/x removed where the box proves that x is finite (and, for x/x, not 0), or the formula
// itself where that is no smaller.
//
// Guarantees: the value on the box changes by rounding only; the verdict of prove_free is the same
// before and after, so that no singularity is hidden and none is made; the paper's complexity does
// not grow. Cost: two proofs, milliseconds.
#pragma once

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// Throws Error (bad_input) as prove_free does.
Expression simplify(const Expression& formula, const InputBox& box);

}  // namespace tribench
