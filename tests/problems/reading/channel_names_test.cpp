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
      {"q [deg]", Role::position, "deg"},
      {"q (deg)", Role::position, "deg"},
      {"q[\xC2\xB0]", Role::position, "deg"},
      {"posDeg", Role::position, "deg"},
      {"i_mA", Role::motor_current, "mA"},
      {"Motor Current (mA)", Role::motor_current, "mA"},
      {"vel_dps", Role::velocity, "deg/s"},
      {"qd_rads", Role::velocity, "rad/s"},
      {"qdd_rads2", Role::acceleration, "rad/s^2"},
      {"joint_velocity_degs", Role::velocity, "deg/s"},
      {"velocity_ms", Role::velocity, "m/s"},
      {"acc_ms2", Role::acceleration, "m/s^2"},
      {"velocity_mms", Role::velocity, "mm/s"},
      {"q_rads", Role::position, "rad"},
      {"position_degs", Role::position, "deg"},
      {"time_ms", Role::time, "ms"},
      {"servo_speed_rads", Role::none, "-"},
      {"motor_speed_rpm", Role::velocity, "rpm"},
      {"speed_1/min", Role::velocity, "rpm"},
      {"speed_deg/s", Role::velocity, "deg/s"},
      {"pos", Role::position, "-"},
      {"cur", Role::motor_current, "-"},
      {"stamp", Role::time, "-"},
      {"effort", Role::motor_torque, "N m"},
      {"tau_J[2]", Role::motor_torque, "N m"},
      {"AIPos.A2", Role::position, "deg"},
      {"header.stamp.nanosec", Role::time, "ns"},
      {"servo_speed_rad_s", Role::none, "rad/s"},
      {"set_speed_rpm", Role::none, "rpm"},
      {"desired_current_A", Role::none, "A"},
      {"rigid_current_A", Role::none, "A"},
      {"torque_enabled", Role::none, "-"},
      {"MAIN.fbAxis.ActPos [\xC2\xB0]", Role::position, "deg"},
      {"axis0.motor.current_control.Iq_measured", Role::motor_current, "-"},
      {"axis0.encoder.vel_estimate [turns/s@motor]", Role::velocity, "rev/s@motor"},
      {"/js/position_deg", Role::position, "deg"},
      {"actuator_torque_Nm", Role::motor_torque, "N m"},
      {"Current Position (deg)", Role::position, "deg"},
      {"present_current", Role::motor_current, "-"},
      {"PositionActualValue", Role::position, "-"},
      {"Torque_Actual_Value", Role::motor_torque, "-"},
      {"joint_temperatures_0", Role::temperature, "degC"},
      {"Speed [0.1 rpm]", Role::velocity, "0.1 rpm"},
      {"p_rad", Role::position, "rad"},
      {"angle_0.01deg", Role::position, "0.01 deg"},
      {"iq_0.5mA", Role::motor_current, "0.5 mA"},
      {"load_cell_10Nm", Role::none, "-"},
      {"tick_ms", Role::time, "ms"},
      {"tick", Role::none, "-"},
      {"x [mm]", Role::position, "mm"},
      {"F [N]", Role::motor_torque, "N"},
      {"T [Nm]", Role::motor_torque, "N m"},
      {"p", Role::none, "-"},
      {"p [bar]", Role::none, "-"},
      {"dc_bus.current", Role::none, "-"},
      {"tcp.position", Role::none, "-"},
      {"target.position", Role::none, "-"},
      {"panda_joint4_position", Role::position, "rad"},
      {"left_arm_joint_3_vel", Role::velocity, "-"},
      {"lbr_A4_torque", Role::motor_torque, "-"},
      {"joint4_gripper_joint2_position", Role::none, "-"},
      {"gripper_joint1_position", Role::none, "-"},
      {"panda_joint4_position_cmd", Role::none, "-"},
      {"model_joint4_torque", Role::none, "-"},
      {"Joint4Position", Role::position, "rad"},
      {"J4Pos", Role::position, "-"},
      {"$JSPEED[4]", Role::velocity, "-"},
      {"positions[3]", Role::position, "rad"},
      {"时间(s)", Role::time, "s"},
      {"位置 [deg]", Role::position, "deg"},
      {"速度[rpm]", Role::velocity, "rpm"},
      {"力矩（Nm）", Role::motor_torque, "N m"},
      {"扭矩", Role::motor_torque, "-"},
      {"电流_mA", Role::motor_current, "mA"},
      {"关节位置", Role::position, "-"},
      {"温度", Role::temperature, "-"},
      {"時間", Role::time, "-"},
      {"トルク [Nm]", Role::motor_torque, "N m"},
      {"電流", Role::motor_current, "-"},
  };
  for (const Case& c : cases) {
    const NameReading reading = read_channel_name(c.name);
    EXPECT_EQ(reading.role, c.role) << c.name;
    EXPECT_EQ(reading.unit, c.unit) << c.name;
  }
}

TEST(ChannelNames, SayTheJointAndTheSideOfTheGear) {
  EXPECT_EQ(read_channel_name("q3").joint, 3);
  EXPECT_EQ(read_channel_name("position[0]").joint, 0);
  EXPECT_EQ(read_channel_name("joint_2_current_A").joint, 2);
  for (const char* name : {"panda_joint4_position", "Joint4Position", "J4Pos", "iiwa_joint_4_vel",
                           "fr3_joint4_effort", "$JSPEED[4]", "关节4位置"}) {
    EXPECT_EQ(read_channel_name(name).joint, 4) << name;
  }
  EXPECT_FALSE(read_channel_name("v2").joint);  // the other joint's velocity
  EXPECT_TRUE(read_channel_name("motor_speed_rpm").at_motor);
  EXPECT_FALSE(read_channel_name("velocity_rad_s").at_motor);
}

TEST(ChannelNames, EveryAliasIsReadAsItself) {
  for (const ChannelAlias& alias : channel_aliases()) {
    if (alias.by_unit) {
      EXPECT_EQ(read_channel_name(alias.name).role, Role::none) << alias.name;
      continue;
    }
    const NameReading reading = read_channel_name(alias.name);
    EXPECT_EQ(reading.role, alias.role) << alias.name;
    EXPECT_EQ(reading.unit, alias.unit.empty() ? "-" : alias.unit) << alias.name;
    EXPECT_EQ(reading.doubt, 0) << alias.name;
  }
}

TEST(Units, ANumberBeforeAUnitIsHowManyOfItACountIs) {
  EXPECT_EQ(find_written_unit("0.229rpm").symbol(), "0.229 rpm");
  EXPECT_EQ(find_written_unit("2.69 mA").scale, 2.69);
  EXPECT_EQ(find_written_unit("0.1%").symbol(), "0.1 %");
  EXPECT_EQ(find_written_unit("-1 rad@motor").symbol(), "-1 rad@motor");
  EXPECT_EQ(find_written_unit("1/min").symbol(), "rpm");
  for (const char* text : {"0 rad", "nan rad", "3", "2 furlong", "rad 2", ""}) {
    EXPECT_EQ(find_written_unit(text).unit, nullptr) << text;
  }
  const Converted fahrenheit = conversion_of(find_written_unit("0.1 degF"), {});
  EXPECT_NEAR((500 + fahrenheit.conversion.offset) * fahrenheit.conversion.factor, 10, 1e-12);
}

TEST(Units, SpellingsAreOneUnitAndStrangersNone) {
  for (const char* text : {"deg/s", "Deg/s", "dps", "\xC2\xB0/s", "deg s^-1", "deg\xC2\xB7s-1"}) {
    ASSERT_NE(find_unit(text), nullptr) << text;
    EXPECT_EQ(find_unit(text)->symbol, "deg/s") << text;
  }
  EXPECT_EQ(find_unit("mNm")->symbol, "mN m");
  EXPECT_EQ(find_unit("N.m")->symbol, "N m");
  EXPECT_EQ(find_unit("mA")->symbol, "mA");
  for (const char* text : {"", "foo", "furlong", "q", "x/s"}) EXPECT_EQ(find_unit(text), nullptr);
}

}  // namespace
}  // namespace tribench
