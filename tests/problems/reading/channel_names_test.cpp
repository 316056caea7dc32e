// SPDX-License-Identifier: MIT
#include "problems/reading/channel_names.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

struct Case {
  const char* name;
  Role role;
  const char* unit;
};

TEST(ChannelNames, SayRoleAndUnit) {
  const std::vector<Case> cases = {
      {"velocity_rad_s", Role::velocity, "rad/s"},
      {"Velocity_rad_s", Role::velocity, "rad/s"},
      {"velocity_m_s", Role::velocity, "m/s"},
      {"qd", Role::velocity, "rad/s"},
      {"position_rad", Role::position, "rad"},
      {"position_m", Role::position, "m"},
      {"acceleration_rad_s2", Role::acceleration, "rad/s^2"},
      {"gravity_torque_Nm", Role::gravity_torque, "N m"},
      {"g", Role::gravity_torque, "N m"},
      {"motor_torque_Nm", Role::motor_torque, "N m"},
      {"motor_force_N", Role::motor_torque, "N"},
      {"tau_f", Role::friction_torque, "N m"},
      {"tau_f_Nm", Role::friction_torque, "N m"},
      {"current_A", Role::motor_current, "A"},
      {"temperature_degC", Role::temperature, "degC"},
      {"T", Role::temperature, "degC"},
      {"t", Role::time, "s"},
      {"time_s", Role::time, "s"},
      {"other_velocity_rad_s", Role::other_velocity, "rad/s"},
      {"other_acceleration_rad_s2", Role::other_acceleration, "rad/s^2"},
      {"sgn_qd", Role::velocity_sign, "-"},
      {"sgn_g", Role::gravity_sign, "-"},
      {"sgn_velocity_rad_s", Role::velocity_sign, "-"},
      {"sgn_x", Role::none, "-"},
      {"movement", Role::movement, "-"},
      {"reference_position_m", Role::none, "m"},
      {"goal_position_rad", Role::none, "rad"},
      {"supply_V", Role::none, "V"},
      {"x1", Role::none, "-"},
      {"", Role::none, "-"},
      {"_s", Role::none, "s"},
  };
  for (const Case& c : cases) {
    const NameReading reading = read_channel_name(c.name);
    EXPECT_EQ(reading.role, c.role) << c.name;
    EXPECT_EQ(reading.unit, c.unit) << c.name;
  }
}

}  // namespace
}  // namespace tribench
