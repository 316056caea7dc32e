// SPDX-License-Identifier: MIT
//
// What is left over that no family explains, where it lives, and which of the families found only
// stood in for it. Internal to the room.
#pragma once

#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {

// Tests the residual of the present model against smooth functions of one and two signals. What is
// left over makes families its proxies, which are dropped; or it is a larger effect's own shape.
void find_leftover(SearchResult& result, const Campaign& campaign, RandomStream random);

}  // namespace tribench::loop
