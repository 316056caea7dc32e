// SPDX-License-Identifier: MIT
//
// The shortest equal formula we find on a box: a descent over the rewrites of rewrite.hpp, each
// taken as it is and in canonical form (canonical.hpp, with x - x, 0 x, x^0 and x/x removed where
// the box proves that x is finite). The shortest of all one rewrite away is
// taken until none is shorter, then the shortest two rewrites away, over a form that may be a
// little longer; shorter is the paper's complexity, then nodes. For a formula that is not proved
// one that is may be longer by one: t / (a + t) for 1 / (a/t + 1) where t may be 0.
//
// Guarantees: the value on the box changes by rounding, and by 1e-12 of a subformula where the
// rewrites leave something out, and the gap that x/x has where x is 0 is closed; the verdict of
// prove_free stays, or the formula becomes one that is proved, so that no singularity is made, and
// none is hidden that is still there; neither complexity
// nor nodes grow where the other does not fall, but for a proof; the same formula gives the same
// result, and the result gives itself.
//
// Equality saturation (e-graphs; Willsey et al. 2021) was weighed against it: sums and products of
// ten parts have thousands of orders and bracketings, which flattened terms have one of, and what
// it adds are rewrites that first lengthen: of those two at a time are enough for what searches
// leave.
//
// Cost: half a millisecond for 31 nodes, five where there is much to shorten (bench/proof_bench).
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
