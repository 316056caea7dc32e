// SPDX-License-Identifier: MIT
//
// Which formula of a front uDSR stands for.
//
// By default the simplest that is typical of the posterior over everything the search has fitted
// (fitting/posterior_choice.hpp). pysr takes the nearest to its mean instead, and charges for
// nodes, since it chooses its formulas node by node. Here nodes come with the constants that every
// term is given, and are no choice; and the front is a path of ever fewer terms, of which the
// larger formulas differ from the mean by what has not been dropped yet.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/udsr/scoring.hpp"

namespace tribench::udsr {

enum class Choice { posterior, simpler, bic, cross_validation, description_length };

Choice choice_of(const std::string& name);

// A formula with its error.
struct Candidate {
  Expression formula;
  double nrmse = std::numeric_limits<double>::infinity();
};

// The place of the choice; front: by increasing complexity, not empty; pool: all that was fitted,
// the front among it. Spends from the budget; once
// that is exhausted the cheapest criterion decides alone. Where the box reaches beyond the rows,
// cross-validation with held-out edges decides.
std::size_t choose(Choice rule, std::span<const Expression> front, std::span<const Candidate> pool,
                   const ScoringProblem& problem, const InputBox& box, Budget& budget);

// The same, but a formula that the proof engine refutes on the box gives way to the next choice,
// unless all are refuted. Where a formula is exact on every row the data have no noise, there is
// nothing to weigh, and the simplest exact one is chosen: where it is singular, so is the law, as
// x^y is at 0.
std::size_t choose_sound(Choice rule, const std::vector<Expression>& front,
                         std::span<const Candidate> pool, const ScoringProblem& problem,
                         const InputBox& box, Budget& budget);

}  // namespace tribench::udsr
