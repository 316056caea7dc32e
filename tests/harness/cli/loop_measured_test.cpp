// SPDX-License-Identifier: MIT
//
// The closed loop on measured data, as a user runs it. Bounds are the figures of
// docs/loop_on_measured_data.md with room for rounding; expectations stand beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "foundation/scratch_folder.hpp"
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
    std::vector<std::string> command = {"loop", (*testing::shared_data() / file).string(),
                                        "--json"};
    command.insert(command.end(), more.begin(), more.end());
    const testing::ProgramRun run = testing::run_tribench(command);
    const Json loop = Json::parse(run.output);
    EXPECT_EQ(run.status, loop["verdict"] == "CANNOT_TELL" ? 4 : 0) << run.errors;
    return loop;
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
TEST_F(MeasuredLoop, EmpsHasViscousFrictionThatDiffersByDirection) {
  const std::vector<std::string> base = {"--model", "20*sgn_v + 200*v - 3"};
  const Json all = loop("emps/emps_estimation.csv", base);
  ASSERT_FALSE(all["effects"].empty());
  EXPECT_EQ(all["effects"][0]["family"], "asymmetry");
  EXPECT_EQ(all["effects"][0]["params"][0]["name"], "viscous_half_gap");
  // An offset of the sensor would be the same in both directions at any speed.
  for (const Json& alias : all["effects"][0]["alias"]) EXPECT_NE(alias["family"], "sensor_offset");
  EXPECT_LT(error(all, "rmse_before"), 2.39);
  EXPECT_LT(error(all, "rmse_after"), 1.51);
  const Json moving = loop("emps/emps_estimation.csv", {base[0], base[1], "--min-speed", "0.005"});
  EXPECT_EQ(moving["effects"][0]["family"], "asymmetry");
  EXPECT_TRUE(moving["confirmed"]);
  EXPECT_LT(error(moving, "rmse_after"), 1.35);
}

// Of a ripple's first column, "cos(1*N*q), ..." or "sgn_v*cos(1*N*q), ...".
double period(const Json& ripple) {
  const std::string atom = ripple["atom"];
  const double k = atom.at(atom.find("cos(") + 4) - '0';
  return 2 * std::numbers::pi / (k * double(ripple["params"].at(2)["value"]));
}

// 0.9 N every 2.5 mm, found without being told a lead. The second recording of the same axis has it
// too, and told another lead nothing but this one is found.
TEST_F(MeasuredLoop, EmpsHasARippleEveryTwoAndAHalfMillimetresOfItsScrew) {
  for (const char* file : {"emps/emps_estimation.csv", "emps/emps_validation_pulses.csv"}) {
    const auto found = [&](std::vector<std::string> more) {
      std::vector<std::string> options = {"--model", "20*sgn_v + 200*v - 3"};
      options.insert(options.end(), more.begin(), more.end());
      return loop(file, options);
    };
    const Json scanned = found({});
    const Json::const_iterator ripple = std::ranges::find_if(
        scanned["effects"], [](const Json& effect) { return effect["family"] == "gear_ripple"; });
    ASSERT_NE(ripple, scanned["effects"].end()) << file;
    EXPECT_NEAR(period(*ripple), 0.0025, 1e-9);
    EXPECT_GT((*ripple)["cv_gain"], 20);
    for (const char* lead : {"0.0023", "0.0027"}) {
      const Json wrong = found({"--screw-lead", lead});
      for (const Json& effect : wrong["effects"]) {
        if (effect["family"] == "gear_ripple") EXPECT_NEAR(period(effect), 0.0025, 1e-5) << lead;
      }
    }
  }
}

TEST_F(MeasuredLoop, Ur10eJoint2HasFrictionThatGrowsWithTheLoad) {
  const Json json = loop("ur10e-dynamic/joint2_dynamic.csv",
                         {"--roles", "recording=movement,rigid_current_A=gravity_torque",
                          "--min-speed", "0.05", "--unordered", "--gear-ratio", "100"});
  ASSERT_FALSE(json["effects"].empty());
  EXPECT_EQ(json["effects"][0]["family"], "load_coulomb");
  EXPECT_TRUE(json["confirmed"]);
  EXPECT_LT(error(json, "rmse_before"), 0.266);
  EXPECT_LT(error(json, "rmse_after"), 0.173);
}

TEST_F(MeasuredLoop, Ur10eJoint1HasViscousFrictionThatSaturates) {
  const Json json = loop("ur10e-dynamic/joint1_dynamic.csv",
                         {"--roles", "recording=movement,rigid_current_A=gravity_torque",
                          "--min-speed", "0.05", "--unordered", "--gear-ratio", "100"});
  EXPECT_THAT(families(json), ::testing::Contains("nonlinear_viscous"));
  EXPECT_LT(error(json, "rmse_after"), 0.121);
}

// Least squares of the speeds' means, each left out in turn: 0.143 -> 0.040 mN m (Stribeck).
TEST_F(MeasuredLoop, ScrewDrive1SlowsDownTheFallOfFrictionAndDrive2ClaimsNothing) {
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

class BamServo : public MeasuredLoop {
 protected:
  static Json servo(std::vector<std::string> options) {
    options.insert(options.end(), {"--roles", "motor_voltage_V=motor_torque,run=movement",
                                   "--where", "torque_enabled=1", "--unordered"});
    return loop("bam-xl330/xl330_pendulum.csv", options);
  }
  // Root mean square, on the same rows, of what anybody who thinks of the load would fit by hand.
  static double error_by_hand(std::vector<std::string> options) {
    options.insert(options.end(), {"--model", "1*sgn_v + 1*v + 0.1*sgn_v*abs(g)"});
    return error(servo(options), "rmse_before");
  }
};

// Judged by leaving out whole trajectories, all four gains of each. Least squares on these rows,
// with the load's inertia fitted to the other trajectories, has a mean error of 0.515 V; with
// gravity alone 0.579 V.
TEST_F(BamServo, HasFrictionThatGrowsWithTheLoad) {
  const std::vector<std::string> options = {"--min-speed", "0.1", "--leave-out", "trajectory"};
  const Json json = servo(options);
  ASSERT_FALSE(json["effects"].empty());
  const Json& load = json["effects"][0];
  EXPECT_EQ(load["family"], "load_coulomb");
  EXPECT_TRUE(json["confirmed"]);
  EXPECT_EQ(json["error"]["how"], "movements of one 'trajectory' left out in turn");
  EXPECT_LT(error(json, "mae_after"), 0.515);
  EXPECT_LT(error(json, "rmse_after"), error_by_hand(options));
  // The load is m g l sin(q) + m l^2 a: 0.0049 kg m^2 of the arm's mass, a little less or more.
  EXPECT_EQ(load["params"].at(1)["name"], "J");
  EXPECT_NEAR(load["params"].at(1)["value"], 0.0049, 0.0015);
}

// Told nothing of a slowest speed, the loop finds from the rows at rest where the direction of
// friction is not known: kept, they would hide everything (1.12 -> 1.10 V). Least squares with the
// load's inertia has a mean error of 0.402 V on the rows that are left.
TEST_F(BamServo, StandsStillAndTheLoopSaysSo) {
  const Json json = servo({});
  // Of 36 %, most are left out as the recording is read.
  EXPECT_THAT(json["warnings"].dump(),
              ::testing::AllOf(::testing::HasSubstr("5940 of 15436 rows, at rest"),
                               ::testing::HasSubstr("the axis stands still in 9 % of the rows")));
  EXPECT_TRUE(json["confirmed"]);
  EXPECT_EQ(json["effects"][0]["family"], "load_coulomb");
  EXPECT_LT(error(json, "mae_before"), 0.56);
  EXPECT_LT(error(json, "mae_after"), 0.402);
  EXPECT_LT(error(json, "rmse_after"), error_by_hand({}));
}

// The ripple at twice a motor turn that the sine's recordings of joints 4, 5 and 6 show: 6 to 16
// mA.
class Ripple : public MeasuredLoop {
 protected:
  static Json sine(int joint, const char* ratio) {
    return loop("ur10e-jointwise/joint" + std::to_string(joint) + ".csv",
                {"--min-speed", "0.05", "--gear-ratio", ratio});
  }

  // Phase, in degrees, of the part that turns its sign with the direction.
  static double phase(const Json& loop) {
    for (const Json& effect : loop["effects"]) {
      if (effect["family"] != "gear_ripple") continue;
      const std::string atom = effect["atom"];
      const bool first = atom.starts_with("sgn_v");
      const std::size_t from = first ? 0 : 3;  // cosine, sine, N of each column
      const double cosine = effect["params"].at(from)["value"];
      const double sine = effect["params"].at(from + 1)["value"];
      return std::atan2(sine, cosine) * 180 / std::numbers::pi;
    }
    ADD_FAILURE() << "no gear_ripple among " << loop["effects"].size() << " effects";
    return 0;
  }
};

// What else is left over lives in speed and place together; friction that changes with the place
// alone tells less than half of it, and is not named.
TEST_F(Ripple, IsAllThatIsNamedOfTheseSines) {
  for (const int joint : {4, 5, 6}) {
    const Json json = sine(joint, "100");
    EXPECT_EQ(families(json), std::vector<std::string>{"gear_ripple"}) << joint;
    EXPECT_EQ(json["verdict"], "UNKNOWN") << joint;
  }
}

TEST_F(Ripple, IsThereAtTheGearsRatioAndAtNoOther) {
  for (const int joint : {5, 6}) {
    EXPECT_THAT(families(sine(joint, "100")), ::testing::Contains("gear_ripple"));
    for (const char* ratio : {"93", "107"}) {
      EXPECT_THAT(families(sine(joint, ratio)), ::testing::Not(::testing::Contains("gear_ripple")));
    }
  }
}

// Other trajectories on other days, all joints moving: the same ripple at the same place of the
// gear. Two phases within 20 degrees by chance: once in 80 times. Joint 4 does not agree, and
// docs/loop_on_measured_data.md says so: where it does, that page is out of date.
TEST_F(Ripple, IsTheSameInRecordingsThatItWasNotFoundOnButOfJoint4) {
  for (const int joint : {4, 5, 6}) {
    const Json dynamic = loop(
        "ur10e-dynamic/joint" + std::to_string(joint) + "_dynamic.csv",
        {"--roles",
         "recording=movement,rigid_current_A=gravity_torque,current_raw_A=motor_current,"
         "current_A=none",
         "--min-speed", "0.03", "--unordered", "--gear-ratio", "100", "--effects", "gear_ripple"});
    EXPECT_LE(dynamic["effects"].at(0)["p_adj"].get<double>(), 0.003) << joint;
    const double apart = std::remainder(phase(dynamic) - phase(sine(joint, "100")), 360);
    EXPECT_EQ(std::abs(apart) < 20, joint != 4) << joint << ": " << apart;
  }
}

// Every second row is the same recording: friction that grows with the load keeps its name, which a
// ripple of the friction twice a turn, nearly the same torque, took in some of the searches.
TEST_F(MeasuredLoop, LoadFrictionKeepsItsNameWithEverySecondRow) {
  const ScratchFolder folder;
  const std::filesystem::path half = folder.path() / "half.csv";
  for (const char* recording : {"ur10e-raw/joint2.csv", "ur10e-jointwise/joint2.csv"}) {
    for (const int kept : {0, 1}) {
      std::ifstream all(*testing::shared_data() / recording);
      std::ofstream out(half);
      std::string line;
      std::getline(all, line);
      out << line << '\n';
      for (int row = 0; std::getline(all, line); ++row) {
        if (row % 2 == kept) out << line << '\n';
      }
      out.close();
      const Json json = loop(half.string(), {"--gear-ratio", "100"});
      EXPECT_THAT(families(json), ::testing::IsSupersetOf({"load_coulomb", "gear_ripple"}))
          << recording << ", every second row from " << kept;
      EXPECT_LT(error(json, "mae_after"), 0.55 * error(json, "mae_before"));
    }
  }
}

// A periodogram of the current over the position has its highest line at 1200 waves a turn, twelve
// a turn of the motor.
TEST_F(MeasuredLoop, KinovaMotorsCogTwelveTimesATurn) {
  for (const int joint : {5, 7}) {
    const Json json = loop("kinova-gen3/joint" + std::to_string(joint) + ".csv",
                           {"--roles", "model_torque_Nm=gravity_torque", "--gear-ratio", "100"});
    const auto& effects = json["effects"];
    const auto ripple = std::ranges::find_if(
        effects, [](const Json& effect) { return effect["family"] == "gear_ripple"; });
    ASSERT_NE(ripple, effects.end()) << joint;
    for (const Json& one : (*ripple)["params"]) {
      if (one["name"] == "N") EXPECT_NEAR(one["value"].get<double>(), 1200, 0.2) << joint;
    }
  }
}

// One pass in one direction: claims about speed come from its start and stop, so they stand under
// UNKNOWN in velocity; what needs both directions or another movement is declined.
TEST_F(MeasuredLoop, KinovaPassesClaimNoEffectOfSpeedLoadOrTimeForCertain) {
  for (int joint = 1; joint <= 7; ++joint) {
    const Json json = loop("kinova-gen3/joint" + std::to_string(joint) + ".csv",
                           {"--roles", "model_torque_Nm=gravity_torque", "--gear-ratio", "100"});
    for (const Json& effect : json["effects"]) {
      const std::string family = effect["family"];
      const bool is_of_position =
          family == "output_ripple" || family == "gear_ripple" || family == "spring";
      EXPECT_TRUE(is_of_position || effect["provisional"]) << joint << ": " << family;
    }
    std::vector<std::string> declined;
    for (const Json& one : json["untestable"]) declined.push_back(one["family"]);
    EXPECT_THAT(declined, ::testing::IsSupersetOf(
                              {"asymmetry", "drift", "temperature", "inertia", "lag", "coupling"}))
        << joint;
  }
}

}  // namespace
}  // namespace tribench
