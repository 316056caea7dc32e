// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using testing::ProgramRun;

ProgramRun run_simulate(const std::string& arguments) {
  return testing::run_tribench_in_shell("simulate " + arguments);
}

nlohmann::json simulate_json(const std::string& arguments) {
  const ProgramRun answer = run_simulate(arguments + " --json");
  EXPECT_EQ(answer.status, 0) << answer.output;
  return nlohmann::json::parse(answer.output, nullptr, false);
}

// Three movements of an inertia of 2 kg m^2 with 3 N m of Coulomb friction under torques of 5, 6
// and 7 N m, from rest: parabolas. Positions are written in degrees.
std::string parabolas(bool with_velocity) {
  std::string text = with_velocity ? "movement,time_s,pos_deg,vel_deg_s,tau_Nm\n"
                                   : "movement,time_s,pos_deg,tau_Nm\n";
  constexpr double kDegree = 180 / std::numbers::pi;
  for (const int torque : {5, 6, 7}) {
    const double a = (torque - 3) / 2.0;
    for (int i = 0; i <= 200; ++i) {
      const double t = 0.005 * i;
      text += fmt::format("m{},{:.17g},{:.17g},", torque, t, a * t * t / 2 * kDegree);
      if (with_velocity) text += fmt::format("{:.17g},", a * t * kDegree);
      text += fmt::format("{}\n", torque);
    }
  }
  return text;
}

class SimulateCommand : public ::testing::Test {
 protected:
  SimulateCommand() {
    testing::write_text(folder_ / "joint.csv", parabolas(true));
    testing::write_text(folder_ / "bare.csv", parabolas(false));
    data_ = (folder_ / "joint.csv").string() +
            " --roles 'pos_deg=position[deg],vel_deg_s=velocity[deg/s],tau_Nm=motor_torque[N m]'";
    bare_ = (folder_ / "bare.csv").string() +
            " --roles 'pos_deg=position[deg],tau_Nm=motor_torque[N m]'";
  }
  testing::TemporaryFolder folder_;
  std::string data_;
  std::string bare_;
};

TEST_F(SimulateCommand, TheRightModelHasNoErrorAndAWrongOneThatOfItsParabola) {
  const auto right = simulate_json("'3*sgn_v' " + data_ + " --inertia 2 --unit deg");
  EXPECT_EQ(right["unit"], "deg");
  EXPECT_EQ(right["movements"].size(), 3U);
  EXPECT_LT(right["training"]["largest_position"].get<double>(), 1e-9);
  const auto wrong = simulate_json("'2*sgn_v' " + data_ + " --inertia 2 --unit deg");
  // a is larger by 1/2: 1/4 rad further after a second, whatever the torque.
  EXPECT_NEAR(wrong["training"]["largest_position"].get<double>(), 45 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(wrong["movements"][0]["largest_position"].get<double>(), 45 / std::numbers::pi, 1e-6);
  EXPECT_EQ(wrong["held_out"]["movements"], 0);
}

TEST_F(SimulateCommand, FitsTheInertiaToTrainingMovementsAloneAndDerivesWhatIsMissing) {
  const auto json =
      simulate_json("'3*sgn_v' " + bare_ + " --inertia fit --split 0.34 --seed 3 --unit deg");
  EXPECT_NEAR(json["inertia"].get<double>(), 2, 0.02);
  EXPECT_EQ(json["held_out"]["movements"], 1);
  EXPECT_EQ(json["training"]["movements"], 2);
  EXPECT_LT(json["held_out"]["mean_position"].get<double>(), 0.5);
  const auto named = simulate_json("'3*sgn_v' " + bare_ + " --inertia fit --split movement=m6");
  EXPECT_EQ(named["movements"][1]["held_out"], true);
  EXPECT_EQ(named["held_out"]["movements"], 1);
}

TEST_F(SimulateCommand, RefinesOnTheMotionAndReadsStates) {
  const auto refined = simulate_json("'2.5*sgn_v + 0.1*v' " + data_ +
                                     " --inertia 2.2 --refine inertia,friction --split 0.34");
  EXPECT_EQ(refined["fit"]["parameters"], 3);
  EXPECT_LT(refined["fit"]["rms_after"].get<double>(), 1e-6);
  EXPECT_NEAR(refined["inertia"].get<double>(), 2, 1e-3);
  EXPECT_LT(refined["held_out"]["largest_position"].get<double>(), 1e-4);
  const auto bristle =
      simulate_json("'z = dahl(v, sliding=1e-4); 3e4*z' " + data_ + " --inertia 2");
  EXPECT_THAT(bristle["formula"].get<std::string>(), HasSubstr("dahl(v"));
  EXPECT_LT(bristle["training"]["largest_position"].get<double>(), 0.0174);
  // Until the bristle is bent it brakes less: v^2 = 2 a q + 2 F d / m, at most sqrt(3e-4) t
  // further.
  EXPECT_GT(bristle["training"]["largest_position"].get<double>(), 1e-3);
}

TEST_F(SimulateCommand, FollowsAReferenceUnderAController) {
  // A stiff PD law holds the joint at the reference, here the column of a constant.
  std::string text = "time_s,q_rad,dq_rad_s,goal\n";
  for (int i = 0; i <= 400; ++i) text += fmt::format("{},0.2,0,0.5\n", 0.005 * i);
  testing::write_text(folder_ / "hold.csv", text);
  const std::string follow =
      "'0.1*sgn_v' " + (folder_ / "hold.csv").string() +
      " --roles q_rad=position,dq_rad_s=velocity --inertia 0.1 --kp 100 --kd 6 --reference ";
  const auto json = simulate_json(follow + "goal");
  EXPECT_NEAR(json["movements"][0]["largest_position"].get<double>(), 0.3, 0.02);
  for (const char* position : {"q_rad", "q"}) {
    const ProgramRun itself = run_simulate(follow + position);
    EXPECT_EQ(itself.status, 2);
    EXPECT_THAT(itself.output, HasSubstr("is the simulated position here"));
  }
}

TEST_F(SimulateCommand, WritesAPageWithAPictureAMovement) {
  const auto out = folder_ / "out";
  EXPECT_EQ(run_simulate("'3*sgn_v' " + data_ + " --inertia 2 --out " + out.string()).status, 0);
  const std::string page = testing::read_text(out / "motion.html");
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = page.find("<svg", at)) != std::string::npos; ++at) ++pictures;
  EXPECT_EQ(pictures, 3U);
  EXPECT_THAT(testing::read_text(out / "motion.csv"), HasSubstr("movement,time_s,measured"));
  const auto json = nlohmann::json::parse(testing::read_text(out / "motion.json"));
  EXPECT_EQ(json["inertia"], 2.0);
}

TEST_F(SimulateCommand, ErrorsNameThePlaceAndTheMend) {
  const auto says = [](const std::string& arguments, const std::string& words) {
    const ProgramRun answer = run_simulate(arguments);
    EXPECT_EQ(answer.status, 2) << arguments;
    EXPECT_THAT(answer.output, HasSubstr(words)) << arguments;
  };
  says("'3*sgn_w' " + data_ + " --inertia 2", "did you mean");
  says("'3*sgn_v' " + data_, "--inertia");
  says("'3*sgn_v' " + data_ + " --inertia -2", "'-2' is no inertia");
  says("'3*sgn_v + 0.1*g' " + data_ + " --inertia 2", "--gravity");
  says("'3*sgn_v' " + data_ + " --inertia 2 --unit mm", "'mm' is no unit of a position in rad");
  says("'3*sgn_v' " + data_ + " --inertia 2 --resistance 3", "--motor-constant");
  says("'3*sgn_v' " + data_ + " --inertia 2 --control '2*(qq - q)'", "no 'qq'");
  says("'3*sgn_v' " + data_ + " --inertia 2 --limit 3", "--control");
  says("'3*sgn_v' " + data_ + " --inertia 2 --kp 3", "--reference");
  says("'3*sgn_v' " + data_ + " --inertia 2 --split movement=m9", "--split");
  says("'3*sgn_v' " + data_ + " --inertia 2 --split time_s=0.5",
       "'time_s' changes within movement 'm5'");
  says("'3*sgn_v' " + data_ + " --inertia 2 --refine mass", "mass");
  says("'3*sgn_v' " + (folder_ / "none.csv").string() + " --inertia 2", "none.csv");
}

// The controller of the EMPS axis, as its gains and its record have it, around the published model:
// the simulated position stays within some micrometres of the recorded one.
TEST_F(SimulateCommand, ReproducesTheEmpsAxisInItsLoop) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const std::string control =
      " --control '35.15065*(243.45*(160.18*(reference_position_m - q) - (q - q_2)/0.002))'"
      " --limit 351.5065";
  const auto json =
      simulate_json("'203.5034*v + 20.3935*sgn_v - 3.1648' " +
                    (*data / "emps/emps_estimation.csv").string() + " --inertia 95.1089" + control);
  EXPECT_LT(json["training"]["rms_position"].get<double>(), 1.7e-6);
  EXPECT_LT(json["training"]["percent_position"].get<double>(), 0.0012);
  const auto fitted = simulate_json(
      "'203.5034*v + 20.3935*sgn_v - 3.1648' " + (*data / "emps/emps_estimation.csv").string() +
      " --inertia fit --test " + (*data / "emps/emps_validation_pulses.csv").string());
  EXPECT_NEAR(fitted["inertia"].get<double>(), 95.1089, 0.05);  // as published
  EXPECT_LT(fitted["held_out"]["rms_position"].get<double>(), 9e-3);
}

}  // namespace
}  // namespace tribench
