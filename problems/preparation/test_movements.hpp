// SPDX-License-Identifier: MIT
//
// Which whole movements of a recording to hold out: spread over directions and speeds. Not for
// folds, which leave every movement out once (algorithms/inference/clusters.hpp).
#pragma once

#include <vector>

#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// share of the movements, ascending; at least one, and none where fewer than two movements would be
// left or the share is 0. However the recording is told, they are the same.
std::vector<int> choose_test_movements(const Observations& data, double share);

}  // namespace tribench::loop
