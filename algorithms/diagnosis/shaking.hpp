// SPDX-License-Identifier: MIT
//
// Whether an effect of the acceleration, or of what the velocity was, goes with the joint's motion
// or with what shakes the joint. Internal to the room.
//
// A torque that nobody recorded (a pump, a cable, another joint) moves the joint a little, and that
// acceleration follows it: what is left over correlates with it and no friction is the cause. What
// the joint does on purpose is smooth. An effect is there in the smooth motion too, to the size
// that it has in all of it; a disturbance is not. The smooth motion is an instrument for the motion
// (Reiersol 1945; of closed loops: Soderstrom, Stoica 1983).
#pragma once

#include <cstddef>

#include "algorithms/campaign/fitted_model.hpp"

namespace tribench::loop {

// True unless half of the effect is there in the smooth motion for certain (two standard errors by
// stretches). Of families that read no acceleration, and without a time in s, nothing is asked:
// false. Cost: the model's linear columns twice, and a few passes over them.
bool goes_with_shaking(const FittedModel& fit, std::size_t family, const Campaign& campaign);

}  // namespace tribench::loop
