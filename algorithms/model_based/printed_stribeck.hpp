// SPDX-License-Identifier: MIT
//
// The static friction model fitted as the paper's was: basin hopping with SciPy's settings over
// all parameters at once, no bounds, NLopt's L-BFGS as the local solver, mean squared error.
//
// The paper does not print its start. Its published optima (Fs in the hundreds or thousands, vs 50
// to 95, delta 9 to 93) have their exponential at 1 over the whole range of the data, where the
// error does not depend on Fc, vs and delta: they lie where the start put them, because steps of
// 0.5 never leave the plateau. We draw the start uniformly from [0, 100] in every parameter, which
// gives optima of that kind and of the published error: Coulomb and linear viscous friction.
#pragma once

#include "algorithms/budget.hpp"
#include "algorithms/model_based/bounded_stribeck.hpp"
#include "algorithms/model_based/stribeck_model.hpp"
#include "foundation/random.hpp"

namespace tribench {

StribeckFit fit_printed_stribeck(const StribeckRows& rows, StribeckModel& model, Budget& budget,
                                 const RandomStream& random);

}  // namespace tribench
