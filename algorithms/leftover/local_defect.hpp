// SPDX-License-Identifier: MIT
//
// Ripples and loads against something at one place of the travel: a dent in a race, a chipped
// tooth, a cable that catches. A few harmonics together come near it, but a bump, which has one
// height for either direction, predicts it better.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "algorithms/campaign/fitted_model.hpp"

namespace tribench::loop {

// By how many nats one bump in place of these families predicts movements left out better than they
// do; none where that is no more than a standard error, and without a position. Cost: rows x
// columns x 240 bumps.
std::optional<double> gain_as_a_defect(const std::vector<std::size_t>& families,
                                       const FittedModel& present, const Campaign& campaign);

}  // namespace tribench::loop
