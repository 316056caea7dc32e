// SPDX-License-Identifier: MIT
//
// Which formula of a front uDSR stands for.
//
// The information criterion (Schwarz 1978) guards against a search that has tried many formulas on
// independent rows, cross-validation over movements against rows that are not independent; the
// simpler of the two choices is the default.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/udsr/scoring.hpp"

namespace tribench::udsr {

enum class Choice { simpler, bic, cross_validation, description_length };

Choice choice_of(const std::string& name);

// The place of the choice; front: by increasing complexity, not empty. Spends from the budget; once
// that is exhausted the cheapest criterion decides alone. Where the box reaches beyond the rows,
// cross-validation with held-out edges decides.
std::size_t choose(Choice rule, std::span<const Expression> front, const ScoringProblem& problem,
                   const InputBox& box, Budget& budget);

// The same, but a formula that the proof engine refutes on the box gives way to the next choice,
// unless all are refuted.
std::size_t choose_sound(Choice rule, const std::vector<Expression>& front,
                         const ScoringProblem& problem, const InputBox& box, Budget& budget);

}  // namespace tribench::udsr
