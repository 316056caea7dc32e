// SPDX-License-Identifier: MIT
//
// From the search's outcome to what is reported: parameters with intervals, physical vetoes, the
// curve of what is left over, the verdict. Internal to the room.
#pragma once

#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {

// Fills in models, effects, leftover, lists and verdict. Intervals are 95 % from the cluster-robust
// covariance; a finding that is not physical is provisional, and the verdict UNKNOWN in its inputs.
void write_findings(Diagnosis& out, const SearchResult& result, const Campaign& campaign);

}  // namespace tribench::loop
