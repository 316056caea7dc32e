// SPDX-License-Identifier: MIT
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

}  // namespace
}  // namespace tribench
