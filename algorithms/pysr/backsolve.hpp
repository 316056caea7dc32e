// SPDX-License-Identifier: MIT
//
// The mutation `backsolve`: what a subtree would have to be for the formula to meet its target, row
// by row, and a sum of subtrees of the population that comes near it.
//
// Source: SymbolicRegression.jl pull requests 573 and 648, as PySR 2 has it (off there and here). A
// row where the way back is not defined (a division by 0, a root of a negative number) is left out
// instead of ending the attempt, and a clone of the parent is no child.
//
// For an improvement to first order that needs no inversion see growth.hpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/pysr/member.hpp"
#include "algorithms/pysr/rows.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

// What the subtree at a place should be, on the rows where that is defined.
struct Demand {
  std::vector<double> values;     // per row; NaN where not defined
  std::vector<std::size_t> rows;  // where it is
};

// The values at `place` with which the formula would meet rows.target. Of an even power or a
// magnitude the branch is that of the current value; sin, cos and sgn are not inverted: then no row
// is defined. O(depth) evaluations.
Demand demand_at(const Expression& formula, std::size_t place, const Rows& rows,
                 Evaluator& evaluator);

// A copy of the parent with a random subtree replaced by c_0 + sum c_k t_k, the t_k chosen one
// after the other from the population's subtrees while the whole has at most max_nodes; none where
// nothing can be inverted or nothing but the parent comes of it, or without budget.
std::optional<Expression> backsolve(const Expression& parent, std::span<const Member> population,
                                    const Rows& rows, std::size_t max_nodes, RandomStream& random,
                                    Budget& budget);

}  // namespace tribench::pysr
