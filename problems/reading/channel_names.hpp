// SPDX-License-Identifier: MIT
//
// What a column's name says about it: `velocity_rad_s` is a velocity in rad/s, `tau_m` a motor
// torque, `sgn_qd` the sign of a velocity. Names that say nothing get the role `none`.
#pragma once

#include <string>
#include <string_view>

#include "problems/dataset.hpp"

namespace tribench {

struct NameReading {
  Role role = Role::none;
  std::string unit;  // SI symbol; "-" where the name has none
};

// Known: time t, movement, position q, velocity v qd dq, acceleration a qdd ddq, gravity_torque
// tau_g g, motor_torque tau_m, friction_torque tau_f friction, external_torque tau_ext,
// temperature T, motor_current current, other_velocity v2, other_acceleration a2, and sgn_X; all
// but T and t whatever the case; with a unit as last part: _rad _rad_s _rad_s2 _deg _deg_s _m _m_s
// _m_s2 _s _Nm _N _A _V _degC _kg _rpm.
NameReading read_channel_name(std::string_view name);

// Torques and what stands for them (a force, a current, a voltage).
bool is_torque_like(Role role);

}  // namespace tribench
