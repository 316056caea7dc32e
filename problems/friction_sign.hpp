// SPDX-License-Identifier: MIT
//
// Whether recorded friction is positive with velocity, as everything here expects it: one rule for
// tables that are fitted and recordings that the loop explains.
//
// Not for torques that inertia or gravity may dominate: those have no sign to be expected.
#pragma once

#include <span>
#include <string>

namespace tribench {

// Correlation of friction and velocity, -1 .. 1; about 0 instead of the means where the velocity
// has one direction (the other reaches less than a tenth of its speed), since friction may well
// fall with speed. 0 where either does not vary. As many values in both, all finite.
double friction_agreement(std::span<const double> friction, std::span<const double> velocity);

// Where friction opposes velocity, of torques that were turned already (--flip-sign) or not.
std::string mend_of_sign(bool turned);

// Throws Error (bad_input) where friction opposes velocity by more than noise does by chance (a
// correlation below -0.1). The names are the columns', `place` is the file's.
void refuse_opposing_friction(std::span<const double> friction, const std::string& friction_name,
                              std::span<const double> velocity, const std::string& velocity_name,
                              const std::string& place, const std::string& mend);

}  // namespace tribench
