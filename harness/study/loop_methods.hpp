// SPDX-License-Identifier: MIT
//
// Methods of diagnosis that the study of the closed loop can judge.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/study/loop_outcome.hpp"

namespace tribench {

// Answers one planted case. Called from several threads at once.
using LoopMethod = std::function<LoopAnswer(const LoopCase&, const PlantedData&)>;

// The closed loop itself, from Coulomb and viscous friction by direction, with rules left out to
// see what they are worth (algorithms/campaign/rules.hpp); none: as it is. Throws Error
// (bad_input) where there is no such rule.
LoopMethod diagnosis_without(std::vector<std::string> rules);

}  // namespace tribench
