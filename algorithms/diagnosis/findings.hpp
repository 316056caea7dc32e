// SPDX-License-Identifier: MIT
//
// From the search's outcome to what is reported: parameters with intervals, physical vetoes, the
// curve of what is left over. Internal to the room.
#pragma once

#include "algorithms/diagnosis/search.hpp"

namespace tribench::loop {

// Parameters of every effect with 95 % intervals from the cluster-robust covariance, their size,
// their collinearity; in the order picked.
std::vector<EffectFinding> effect_findings(const Search& search, const Observations& train,
                                           const std::vector<EffectFamily>& families);

// What an effect's parameters say against its being physical; empty where nothing.
std::string physical_objection(const EffectFinding& finding, const EffectFamily& family);

// The residual over the leftover's one input: means of 40 bins with their standard errors.
std::vector<CurvePoint> leftover_curve(const Search& search, const Observations& train);

}  // namespace tribench::loop
