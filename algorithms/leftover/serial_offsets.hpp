// SPDX-License-Identifier: MIT
//
// Whether movements that follow one another have offsets, or Coulomb friction, that are alike
// though no effect says why: a zero that jumped, an afternoon that was warmer, grease that comes
// and goes, a drift of another shape. To the noise model the offset of a movement is chance, one
// movement's as good as any other's; a smooth function of time is then worth next to nothing, since
// what it tells is what the random intercept takes up. Their order is what no chance has.
//
// Not for campaigns whose order does not count, nor for what changes within movements.
// Source: von Neumann 1941 (the ratio of the mean square successive difference to the variance), by
// permutation.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "algorithms/campaign/fitted_model.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// The share of orders in which neighbours would be so much alike, twice the smaller of that of the
// offsets and that of what goes with the direction; none without a time, and with fewer than twenty
// movements. Cost: movements x permutations.
std::optional<double> serial_offsets_p(const FittedModel& fit, const Campaign& campaign,
                                       RandomStream random);

// Smooth functions of the time, each movement at its mean, and the same times the direction: what
// such movements have. Of 24 centres, or one to three movements.
Eigen::MatrixXd time_of_movements(const Campaign& campaign);

}  // namespace tribench::loop
