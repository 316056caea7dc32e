// SPDX-License-Identifier: MIT
//
// Fits again from other random numbers until the budget is spent, where the user gave one: every
// method stops when its own search has come to rest, after a second or so, whatever it was given.
//
// A round searches wider than the one before where its method can (AlgorithmEntry::widened). All
// rounds' formulas form one front (fitting/joint_front.hpp); a round that had no time to hold its
// choice against as many unseen rows as the first only adds formulas. It ends early where the rows
// are explained to rounding, and where rounds give what the one before gave: one of a method that
// does not widen, three of one that does. With a budget of evaluations the same rounds are run on
// any machine.
//
// Not where budgets are ceilings, as they are in a grid that does not say `spend = true`.
#pragma once

#include <functional>

#include "algorithms/regressor.hpp"

namespace tribench {

// The round of this number, from 1 on: a fit with these random numbers, its front finished
// (finished_front.hpp).
using FitRound = std::function<FitResult(RandomStream random, int round)>;

// `first` is round 0, already done; `budget` the one that the rounds spend; `widens`: whether a
// round may find what the one before could not, without other random numbers.
FitResult fit_until_spent(FitResult first, const FitRound& round, bool widens,
                          const TrainingData& data, const Budget& budget,
                          const RandomStream& random);

}  // namespace tribench
