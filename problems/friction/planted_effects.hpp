// SPDX-License-Identifier: MIT
//
// Effects that can be planted in generated friction: what a diagnosis has to find. Their shapes are
// deliberately not those a library of effects would try first (Stribeck velocity 0.06 with exponent
// 2, a fourth power, a phase of 0.7 rad, ...), and four of them belong to no such library at all.
//
// Source: the specification of the closed loop, sections 2, 6.1 and 8.4. Friction is positive with
// velocity; s is the velocity's sign, u the time as a part of the campaign, d the distance since
// the last reversal.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

// What an effect can depend on, at one instant.
struct JointState {
  double position_rad = 0;
  double velocity_rad_s = 0;
  double acceleration_rad_s2 = 0;
  double gravity_nm = 0;
  double temperature_degc = 0;
  double campaign_part = 0;  // u, 0 to 1
  double distance_rad = 0;   // d
  double other_velocity_rad_s = 0;
  double other_acceleration_rad_s2 = 0;
};

struct PlantedShape {
  std::string_view family;     // as in loop.json for the library's families
  std::string_view formula;    // for people
  bool in_library = true;      // false: a diagnosis must answer UNKNOWN
  std::vector<Role> lives_in;  // the inputs it depends on, beside the velocity's sign
  double (*at)(const JointState& state) = nullptr;  // to be scaled
};

// The library's families first, in the order of the specification, then the four outside it.
const std::vector<PlantedShape>& planted_shapes();

// Throws Error (bad_input) with the nearest name.
const PlantedShape& find_planted_shape(std::string_view family);

}  // namespace tribench
