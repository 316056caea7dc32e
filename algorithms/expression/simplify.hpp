// SPDX-License-Identifier: MIT
//
// The shortest equal formula we find on a box: a descent over the rewrites of rewrite.hpp, each
// taken as it is and in canonical form (canonical.hpp, with x - x, 0 x, x^0 and x/x removed where
// the box proves that x is finite and, for x/x, not 0). The shortest of all one rewrite away is
// taken until none is shorter; shorter is the paper's complexity, then nodes.
//
// Guarantees: the value on the box changes by rounding, and by 1e-12 of a subformula where the
// rewrites leave something out; the verdict of prove_free is the same before and after, so that no
// singularity is hidden and none is made; neither complexity nor nodes grow where the other does
// not fall; the same formula gives the same result, and the result gives itself.
//
// Equality saturation (e-graphs; Willsey et al. 2021) was weighed against it: sums and products of
// ten parts have thousands of orders and bracketings, which flattened terms have one of, and what
// it adds are rewrites that first lengthen. Of those we take the useful one, multiplying out,
// together with the canonical form that follows.
//
// Cost: about a millisecond for 30 nodes (bench/proof_bench).
#pragma once

#include <functional>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// `admits` refuses forms that the caller cannot use (operators that a set lacks); empty admits all.
// Throws Error (bad_input) as prove_free does.
Expression simplify(const Expression& formula, const InputBox& box,
                    const std::function<bool(const Expression&)>& admits = {});

}  // namespace tribench
