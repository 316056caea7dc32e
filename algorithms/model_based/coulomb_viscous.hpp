// SPDX-License-Identifier: MIT
//
// The static friction model without its Stribeck term: linear in all that is left, solved exactly
// by least squares under Fc >= 0. What published identifications of drives report, and what the
// Stribeck forms must beat.
//
// Cost: one solve, or at most 2^branches of them where a Coulomb level would be negative.
#pragma once

#include "algorithms/budget.hpp"
#include "algorithms/model_based/bounded_stribeck.hpp"
#include "algorithms/model_based/stribeck_model.hpp"

namespace tribench {

// Writes Fc and Fv of every branch, offset and inertia where the model has them; Fs - Fc is 0.
StribeckFit fit_coulomb_viscous(const StribeckRows& rows, StribeckModel& model, Budget& budget);

}  // namespace tribench
