// SPDX-License-Identifier: MIT
//
// Makes a trained model sparse by taking out one parameter after the other, linear or inner, always
// that whose loss hurts least, and fitting the rest anew. Every step of the way is kept, for a
// criterion to choose from.
//
// This takes the place of the published ladder of cut-offs: what a parameter is worth is read off
// the curvature of the fit (Wald), not off its size.
#pragma once

#include <vector>

#include "algorithms/parfam/formula.hpp"
#include "algorithms/parfam/pole_guard.hpp"

namespace tribench::parfam {

// From the model as given to one of few parameters; empty without budget. `guard` keeps constrained
// denominators from 0 at every step; null for the others.
std::vector<TrainedModel> eliminate(const TrainedModel& model,
                                    std::span<const double* const> inputs,
                                    std::span<const double> y, Denominators denominators,
                                    const PoleGuard* guard, Budget& budget);

}  // namespace tribench::parfam
