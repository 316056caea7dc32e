// SPDX-License-Identifier: MIT
//
// The closed loop on measured data, as a user runs it. Bounds are the figures of
// docs/closed_loop.md with room for rounding; expectations stand beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using Json = nlohmann::json;

class MeasuredLoop : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::shared_data()) GTEST_SKIP() << testing::kNoSharedData;
  }

  static Json loop(const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> command = {testing::program().string(), "loop",
                                        (*testing::shared_data() / file).string(), "--json"};
    command.insert(command.end(), more.begin(), more.end());
    const testing::ProgramRun run = testing::run_to_end(command);
    EXPECT_EQ(run.status, 0) << run.errors;
    return Json::parse(run.output);
  }

  static std::vector<std::string> families(const Json& loop) {
    std::vector<std::string> names;
    for (const Json& effect : loop["effects"]) names.push_back(effect["family"]);
    return names;
  }

  static double error(const Json& loop, const char* key) { return loop["error"][key]; }
};

// The model of the published figures: symmetric with an offset. Plain least squares with the effect
// named here gives 2.39 -> 1.92 N on all rows and 2.18 -> 1.68 N without the slowest 2 %.
TEST_F(MeasuredLoop, emps_has_viscous_friction_that_differs_by_direction) {
  const std::vector<std::string> base = {"--model", "20*sgn_v + 200*v - 3"};
  const Json all = loop("emps/emps_estimation.csv", base);
  ASSERT_FALSE(all["effects"].empty());
  EXPECT_EQ(all["effects"][0]["family"], "asymmetry");
  EXPECT_EQ(all["effects"][0]["params"][0]["name"], "viscous_half_gap");
  EXPECT_LT(error(all, "rmse_before"), 2.39);
  EXPECT_LT(error(all, "rmse_after"), 1.76);
  const Json moving = loop("emps/emps_estimation.csv", {base[0], base[1], "--min-speed", "0.005"});
  EXPECT_EQ(moving["effects"][0]["family"], "asymmetry");
  EXPECT_TRUE(moving["confirmed"]);
  EXPECT_LT(error(moving, "rmse_after"), 1.67);
}

TEST_F(MeasuredLoop, ur10e_joint_2_has_friction_that_grows_with_the_load) {
  const Json json = loop("ur10e-dynamic/joint2_dynamic.csv",
                         {"--roles", "recording=movement,rigid_current_A=gravity_torque",
                          "--min-speed", "0.05", "--unordered", "--gear-ratio", "100"});
  ASSERT_FALSE(json["effects"].empty());
  EXPECT_EQ(json["effects"][0]["family"], "load_coulomb");
  EXPECT_TRUE(json["confirmed"]);
  EXPECT_LT(error(json, "rmse_before"), 0.266);
  EXPECT_LT(error(json, "rmse_after"), 0.173);
}

TEST_F(MeasuredLoop, ur10e_joint_1_has_viscous_friction_that_saturates) {
  const Json json = loop("ur10e-dynamic/joint1_dynamic.csv",
                         {"--roles", "recording=movement,rigid_current_A=gravity_torque",
                          "--min-speed", "0.05", "--unordered", "--gear-ratio", "100"});
  EXPECT_THAT(families(json), ::testing::Contains("nonlinear_viscous"));
  EXPECT_LT(error(json, "rmse_after"), 0.121);
}

// Least squares of the speeds' means, each left out in turn: 0.143 -> 0.040 mN m (Stribeck).
TEST_F(MeasuredLoop, screw_drive_1_slows_down_the_fall_of_friction_and_drive_2_claims_nothing) {
  const std::vector<std::string> options = {"--roles", "set_speed_rpm=movement", "--unordered",
                                            "--steady"};
  const Json one = loop("screw-drives/drive1_steady.csv", options);
  ASSERT_EQ(one["effects"].size(), 1U);
  EXPECT_THAT(families(one),
              ::testing::Contains(::testing::AnyOf("stribeck", "nonlinear_viscous")));
  EXPECT_TRUE(one["confirmed"]);
  EXPECT_GT(error(one, "means_before"), 0.143e-3);
  EXPECT_LT(error(one, "means_after"), 0.0405e-3);
  const Json two = loop("screw-drives/drive2_steady.csv", options);
  EXPECT_EQ(two["verdict"], "NONE");
  EXPECT_TRUE(two["effects"].empty());
}

TEST_F(MeasuredLoop, bam_servo_has_friction_that_grows_with_the_load) {
  const Json json = loop("bam-xl330/xl330_pendulum.csv",
                         {"--roles", "motor_voltage_V=motor_torque,run=movement", "--where",
                          "torque_enabled=1", "--min-speed", "0.1", "--unordered"});
  ASSERT_FALSE(json["effects"].empty());
  EXPECT_EQ(json["effects"][0]["family"], "load_coulomb");
  EXPECT_TRUE(json["confirmed"]);
  EXPECT_LT(error(json, "rmse_after"), 0.65);
}

// A ripple of 6 mA once in half a motor turn: there at the gear's own ratio and at no other.
TEST_F(MeasuredLoop, ur10e_ripple_is_there_at_the_gears_ratio_and_at_no_other) {
  for (const char* joint : {"ur10e-jointwise/joint5.csv", "ur10e-jointwise/joint6.csv"}) {
    EXPECT_THAT(families(loop(joint, {"--min-speed", "0.05", "--gear-ratio", "100"})),
                ::testing::Contains("gear_ripple"));
    for (const char* ratio : {"93", "107"}) {
      EXPECT_THAT(families(loop(joint, {"--min-speed", "0.05", "--gear-ratio", ratio})),
                  ::testing::Not(::testing::Contains("gear_ripple")));
    }
  }
}

}  // namespace
}  // namespace tribench
