// SPDX-License-Identifier: MIT
//
// What a column's name says about it: `velocity_rad_s` is a velocity in rad/s, `q [deg]` a
// position in degrees, `tau_J_2` the torque of joint 2, `sgn_qd` the sign of a velocity. The names
// themselves, with where each comes from, stand in channel_aliases.cpp. Set points (desired,
// commanded, target ...) and names that say nothing have the role `none`. Accents, Greek
// letters and LaTeX's signs are read as plain letters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "problems/dataset.hpp"
#include "problems/reading/units.hpp"

namespace tribench {

struct NameReading {
  Role role = Role::none;
  std::string unit;  // symbol; "-" where the name has none
  // The unit that is written in the name, else the one that its source always uses; or neither.
  // A source's own may be none of the role (KRL's velocity, in per cent of the fastest).
  WrittenUnit known = {};
  bool unit_written = false;  // in the name itself
  std::string unknown_unit;   // in brackets, and unknown
  std::string_view source;    // who names a channel so
  bool at_motor = false;      // the name or its unit says the motor's side of the gear
  std::optional<int> joint;   // the number in the name
  int doubt = 0;              // of two columns with one role the lower one has it
};

// A unit stands in brackets ("q [deg]", "q (deg)"), last ("q_deg", "qDeg", "q in deg") or first
// ("deg_q"); a number is the joint's. Letters' case decides between t and T alone, and only where
// no unit does.
NameReading read_channel_name(std::string_view name);

// "Strom" of "Strom [A]": what stands before the brackets.
std::string_view without_unit(std::string_view name);

// Torques and what stands for them (a force, a current, a voltage).
bool is_torque_like(Role role);

struct ChannelAlias {
  std::string_view name;  // lower case, words apart by '_'
  Role role;
  std::string_view unit;    // that this source always uses; empty where it differs
  std::string_view source;  // whose name it is
  bool by_unit = false;     // means nothing without a written unit that suits
};
std::span<const ChannelAlias> channel_aliases();

}  // namespace tribench
