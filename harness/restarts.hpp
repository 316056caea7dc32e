// SPDX-License-Identifier: MIT
//
// Fits again from other random numbers until the budget is spent, where the user gave one: every
// method stops when its own search has come to rest, after a second or so, whatever it was given.
//
// All rounds' formulas form one front; the formula chosen is the exact one where there is one
// (fitting/exact_choice.hpp), else the one of the rounds' choices with the most evidence
// (fitting/evidence.hpp). It ends early where the rows are explained to rounding, and where a round
// gives what the round before gave (a method without random numbers). With a budget of evaluations
// the same rounds are run on any machine.
//
// Not for cells of a grid, whose budgets are ceilings.
#pragma once

#include <functional>

#include "algorithms/regressor.hpp"

namespace tribench {

// One round: a fit with these random numbers, its front finished (finished_front.hpp).
using FitRound = std::function<FitResult(RandomStream random)>;

// `first` is the round already done; `budget` the one that the rounds spend.
FitResult fit_until_spent(FitResult first, const FitRound& round, const TrainingData& data,
                          const Budget& budget, const RandomStream& random);

}  // namespace tribench
