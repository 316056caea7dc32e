// SPDX-License-Identifier: MIT
//
// Methods of diagnosis that the study of the closed loop can judge.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/study/loop_outcome.hpp"

namespace tribench {

// The gear ratio of every planted campaign; methods are told.
inline constexpr double kPlantedGearRatio = 160;

// Answers one planted case. Called from several threads at once.
using LoopMethod = std::function<LoopAnswer(const LoopCase&, const kuka::PlantedData&)>;

// The closed loop itself, from Coulomb and viscous friction by direction. Planted signs are random,
// so the physical vetoes are off.
LoopAnswer diagnose_case(const LoopCase& one, const kuka::PlantedData& planted);

}  // namespace tribench
