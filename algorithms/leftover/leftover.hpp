// SPDX-License-Identifier: MIT
//
// What is left over that no family explains, where it lives, and which of the families found only
// stood in for it.
#pragma once

#include "algorithms/campaign/search_state.hpp"
#include "algorithms/leftover/leftover_finding.hpp"

namespace tribench::loop {

// Tests the residual of the present model against smooth functions of one and two signals. What is
// left over makes families its proxies, which are dropped; or it is a larger effect's own shape.
LeftoverFinding find_leftover(SearchState& state, const Campaign& campaign, RandomStream random);

}  // namespace tribench::loop
