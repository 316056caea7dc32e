// SPDX-License-Identifier: MIT
//
// What becomes of the hall of fame before anyone sees it: every formula's constants are brought to
// convergence on all rows, the most promising ones are grown, pruned and exchanged by evidence, and
// what is left is a front.
#pragma once

#include <functional>
#include <vector>

#include "algorithms/pysr/climber.hpp"
#include "algorithms/pysr/selection.hpp"

namespace tribench::pysr {

struct Candidate {
  Expression formula;
  FrontPoint point;  // size is the paper's complexity, of the formula written out
};

// `climber` works on all rows; the formulas are of `form`, over its columns. `admitted` says
// whether a formula may enter the front beyond what the validator says (a proof); empty where all
// may. The result is reduced to what no other beats in both complexity and loss, by increasing
// complexity. Deterministic; ends early with the budget.
std::vector<Candidate> refined_front(Climber& climber, const Options& options, const Form& form,
                                     const Rows& rows, const std::vector<Member>& members,
                                     const std::function<bool(const Expression&)>& admitted,
                                     RandomStream random, Budget& budget);

}  // namespace tribench::pysr
