// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string joint_complaint(std::string_view text, const CsvOptions& options = {}) {
  try {
    parse_csv(text, "arm.csv", options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(JointColumns, OfSeveralJointsOneIsAskedFor) {
  const std::string_view text = "t,q1,dq1,q2,dq2,tau_J_1,tau_J_2\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n";
  EXPECT_EQ(parse_csv(text, "arm.csv").joints, (std::vector<int>{1, 2}));
  CsvOptions options;
  options.joint = 2;
  const Dataset data = parse_csv(text, "arm.csv", options).data;
  EXPECT_EQ(data.find(Role::position)->name, "q2");
  EXPECT_EQ(data.find(Role::motor_torque)->name, "tau_J_2");
  EXPECT_EQ(data.find(Role::other_velocity)->name, "dq1");
  options.joint = 5;
  EXPECT_THAT(joint_complaint(text, options), HasSubstr("joints: 1, 2"));
}

TEST(JointColumns, OfSeveralJointsTheOneIsMeantWhoseRolesAreGiven) {
  const std::string_view text = "t,q1,tau_J_1,T1,q2,tau_J_2\n0,1,5,20,3,6\n1,1,5,21,3,6\n";
  CsvOptions options;
  options.roles = parse_roles("q2=position[rad],tau_J_2=motor_torque[N m]", "--roles");
  for (const std::optional<int> joint : {std::optional<int>(), std::optional(2)}) {
    options.joint = joint;
    const Dataset data = parse_csv(text, "arm.csv", options).data;
    EXPECT_EQ(data.find(Role::position)->name, "q2");
    EXPECT_EQ(data.find(Role::temperature), nullptr) << "the other joint's";
  }
}

TEST(JointColumns, JointsThatWordsTellApartAreAskedFor) {
  const std::string arm =
      "time,/arm/shoulder/position,/arm/shoulder/effort,/arm/elbow/position,/arm/elbow/effort\n"
      "0,1,2,3,4\n1,1,2,3,4\n";
  EXPECT_THAT(joint_complaint(arm), AllOf(HasSubstr("'shoulder', 'elbow'"),
                                          HasSubstr("/arm/shoulder/position=position")));
  CsvOptions options;
  options.roles = parse_roles("/arm/elbow/position=position[rad]", "--roles");
  EXPECT_THAT(joint_complaint(arm, options), ::testing::Not(HasSubstr("several joints")));
  EXPECT_THAT(joint_complaint("time,raw_position,raw_velocity,filtered_position,filtered_velocity\n"
                              "0,1,2,3,4\n1,1,2,3,4\n"),
              ::testing::Not(HasSubstr("several joints")));
}

TEST(JointColumns, AJointMayBeAskedForByItsWord) {
  const std::string names[] = {"shoulder_pan", "elbow", "wrist_1"};
  for (const char* pattern : {"{}_{}", "{}_joint_{}", "/arm/{}_joint/{}", "left.{}.{}"}) {
    std::string text = "time";
    for (const std::string& name : names) {
      for (const char* quantity : {"position", "velocity", "effort"}) {
        text += "," + fmt::format(fmt::runtime(pattern), name, quantity);
      }
    }
    text += "\n0,1,2,3,4,5,6,7,8,9\n1,1,2,3,4,5,6,7,8,9\n";
    CsvOptions options;
    for (std::size_t k = 0; k < 3; ++k) {
      options.joint_word = k == 1 ? "Elbow_joint" : names[k];
      const Dataset data = parse_csv(text, "arm.csv", options).data;
      ASSERT_NE(data.find(Role::position), nullptr) << text;
      EXPECT_EQ(data.find(Role::position)->values[0], 1.0 + 3.0 * static_cast<double>(k)) << text;
      EXPECT_EQ(data.find(Role::motor_torque)->values[0], 3.0 + 3.0 * static_cast<double>(k));
    }
    options.joint_word = "hip";
    EXPECT_THAT(joint_complaint(text, options), HasSubstr("joints: shoulder_pan, elbow, wrist_1"));
    EXPECT_THAT(joint_complaint(text), AllOf(HasSubstr("'shoulder_pan', 'elbow', 'wrist_1'"),
                                             HasSubstr("--joint shoulder_pan")));
  }
}

TEST(JointColumns, CamelCaseAndUnitsTellJointsByWordsToo) {
  CsvOptions options;
  options.joint_word = "ELBOW";
  const Dataset data =
      parse_csv(
          "t,ShoulderPosition [deg],ShoulderCurrent [mA],ElbowPosition [deg],ElbowCurrent [mA]\n"
          "0,1,2,180,4000\n1,1,2,180,4000\n",
          "arm.csv", options)
          .data;
  EXPECT_NEAR(data.find(Role::position)->values[0], 3.14159, 1e-4);
  EXPECT_NEAR(data.find(Role::motor_current)->values[0], 4, 1e-9);
}

TEST(JointColumns, TheOnlyJointsWordIsNotAskedFor) {
  const DataFile file =
      parse_csv("time,elbow_position,elbow_velocity,elbow_effort\n0,1,2,3\n1,1,2,3\n", "arm.csv");
  EXPECT_EQ(file.data.find(Role::motor_torque)->name, "elbow_effort");
  EXPECT_THAT(file.warnings, ::testing::ElementsAre(HasSubstr("'elbow'")));
  // Beside the joint's own columns, a setting, or another place, a strange word is no joint.
  for (const char* names :
       {"time,servo_speed,servo_torque,dq,tau", "t,gripper_position,gripper_effort,q,tau",
        "t,desired_position,desired_velocity,q,tau"}) {
    const DataFile other = parse_csv(std::string(names) + "\n0,1,2,3,4\n1,1,2,3,4\n", "arm.csv");
    EXPECT_EQ(other.data.find(Role::motor_torque)->name, "tau") << names;
  }
}

TEST(JointColumns, ABaseIsAJointBesideOthers) {
  CsvOptions options;
  options.joint_word = "base";
  EXPECT_EQ(
      parse_csv("t,base_position,base_effort,elbow_position,elbow_effort\n0,1,2,3,4\n1,1,2,3,4\n",
                "ur.csv", options)
          .data.find(Role::motor_torque)
          ->values[0],
      2);
}

// Where nothing but the joints' columns is known, they are what is said.
TEST(JointColumns, JointsAreAskedForWhereNoOtherColumnIsKnown) {
  CsvOptions options;
  options.used = std::vector<std::string>();
  EXPECT_THAT(joint_complaint("Tick,J1 Pos(deg),J2 Pos(deg),J1 Current(%),J2 Current(%)\n"
                              "0,1,2,3,4\n1,1,2,3,4\n",
                              options),
              AllOf(HasSubstr("columns of the joints 1, 2 stand here"), HasSubstr("--joint N")));
}

// KRL's $VEL_AXIS_ACT counts per cent of the axis's fastest: a velocity, and in no unit.
TEST(JointColumns, AVelocityInPerCentIsAskedFor) {
  const std::string_view kuka =
      "t,$AXIS_ACT[4],$VEL_AXIS_ACT[4],$TORQUE_AXIS_ACT[4]\n0,1,2,3\n1,2,2,3\n";
  CsvOptions options;
  EXPECT_THAT(joint_complaint(kuka),
              AllOf(HasSubstr("'%' is no unit of a velocity"), HasSubstr("velocity[1.8 deg/s]")));
  options.roles = parse_roles("$VEL_AXIS_ACT[4]=velocity", "--roles");
  EXPECT_THAT(joint_complaint(kuka, options), HasSubstr("'%' is no unit"));
  options.roles = parse_roles("$VEL_AXIS_ACT[4]=velocity[180 deg/s]", "--roles");
  EXPECT_NEAR(parse_csv(kuka, "arm.csv", options).data.find(Role::velocity)->values[0], 6.2832,
              1e-4);
}

TEST(JointColumns, TheArmsNameMayStandBeforeTheJoint) {
  const std::string_view text =
      "time,panda_joint1_position,panda_joint1_effort,panda_joint2_position,panda_joint2_velocity,"
      "panda_joint2_effort\n0,1,2,3,4,5\n1,1,2,3,4,5\n";
  EXPECT_EQ(parse_csv(text, "arm.csv").joints, (std::vector<int>{1, 2}));
  CsvOptions options;
  options.joint = 2;
  EXPECT_EQ(parse_csv(text, "arm.csv", options).data.find(Role::motor_torque)->name,
            "panda_joint2_effort");
}

}  // namespace
}  // namespace tribench
