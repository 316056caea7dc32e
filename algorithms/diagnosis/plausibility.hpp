// SPDX-License-Identifier: MIT
//
// Whether an effect, as it was fitted, can be what its name says. Internal to the room.
#pragma once

#include "algorithms/campaign/fitted_model.hpp"
#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

// A model with an effect whose sign its cause cannot have, or with a curve of speed that another
// cause draws: beside Coulomb and viscous friction two families can draw the same curve, told apart
// by whether friction falls. Nothing where the options ask for no physics.
bool stands_for_another_cause(const LoopModel& model, const Campaign& campaign);

// So little is its own that effects may cancel each other (Marquardt 1970).
inline constexpr double kLargeVif = 10;

// Whether little of the effect's torque, beside what the base can do, is left beside the other
// effects: the variance inflation of the effect as a whole.
bool is_told_by_others(std::size_t family, const FittedModel& fit, const Campaign& campaign);

// Whether a model that has not the effect tells the torque that it has in another model.
bool is_told_by_another_name(std::size_t family, const LoopModel& other, const FittedModel& fit,
                             const Campaign& campaign);

// What an effect's parameters say against its being physical; empty where nothing.
std::string physical_objection(const EffectFinding& finding, const EffectFamily& known);

}  // namespace tribench::loop
