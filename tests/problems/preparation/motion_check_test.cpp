// SPDX-License-Identifier: MIT
#include "problems/preparation/motion_check.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

struct Told {
  std::vector<double> time, position, velocity;
};

Told sine(double delay) {
  Told told;
  for (int i = 0; i < 6000; ++i) {
    const double t = 0.002 * i;
    told.time.push_back(t);
    told.position.push_back(0.6 * std::sin(2 * t));
    told.velocity.push_back(1.2 * std::cos(2 * (t - delay)));
  }
  return told;
}

TEST(MotionCheck, TheSlopeIsTheFactorBetweenTheUnits) {
  Told told = sine(0);
  const std::vector<RowRange> whole = {{0, told.time.size()}};
  EXPECT_NEAR(match_motion(told.time, told.position, told.velocity, whole).slope, 1, 1e-3);
  for (double& v : told.velocity) v *= -9.5;
  const MotionMatch match = match_motion(told.time, told.position, told.velocity, whole);
  EXPECT_NEAR(match.slope, -1 / 9.5, 1e-3);
  EXPECT_LT(match.agreement, -0.99);
}

// A file of q, qd and qdd as they are given, SI throughout; flipped: read with --flip-sign.
std::string complaint_about(const std::vector<double>& time, const std::vector<double>& q,
                            const std::vector<double>& qd, const std::vector<double>& qdd,
                            bool flipped = false) {
  std::string text = "t,q,qd,qdd\n";
  for (std::size_t i = 0; i < time.size(); ++i) {
    text += fmt::format("{},{},{},{}\n", time[i], q[i], qd[i], qdd[i]);
  }
  try {
    DataFile file = parse_csv(text, "d.csv");
    file.data.torques_flipped = flipped;
    check_motion(file, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MotionCheck, ColumnsThatTellOfDifferentMotionsAreRefused) {
  const Told told = sine(0);
  std::vector<double> acceleration, degrees, other, late, still(told.time.size(), 0.4);
  for (const double t : told.time) {
    acceleration.push_back(-2.4 * std::sin(2 * t));
    degrees.push_back(-2.4 * std::sin(2 * t) * 180 / std::numbers::pi);
    other.push_back(0.8 * std::cos(2.9 * t + 1));
    late.push_back(-2.4 * std::sin(2 * t - std::numbers::pi / 2));
  }
  const auto says = [&](const std::vector<double>& q, const std::vector<double>& qd,
                        const std::vector<double>& qdd) {
    return complaint_about(told.time, q, qd, qdd);
  };
  EXPECT_EQ(says(told.position, told.velocity, acceleration), "no error");
  EXPECT_THAT(says(told.position, other, acceleration),
              HasSubstr("'qd' does not tell how 'q' changes"));
  EXPECT_THAT(says(told.velocity, told.position, acceleration),
              HasSubstr("give --roles 'qd=position,q=velocity'"));
  EXPECT_THAT(says(told.position, told.velocity, late),
              HasSubstr("'qdd' does not tell how 'qd' changes"));
  EXPECT_THAT(says(told.position, told.velocity, degrees), HasSubstr("qdd=acceleration[deg/s^2]"));
  for (double& a : acceleration) a = -a;
  EXPECT_THAT(says(told.position, told.velocity, acceleration), HasSubstr("its sign is turned"));
  EXPECT_THAT(says(still, told.velocity, late), HasSubstr("'q' is 0.4 in every row"));
}

// The torques go with one of the two, and are turned or not already: the mend says what is to be
// changed, and not what is so already.
TEST(MotionCheck, AVelocityOfTheOtherSignIsMendedByTurningOneOfTheTwo) {
  Told told = sine(0);
  std::vector<double> acceleration;
  for (const double t : told.time) acceleration.push_back(2.4 * std::sin(2 * t));
  for (double& v : told.velocity) v = -v;
  for (const bool flipped : {false, true}) {
    const std::string says =
        complaint_about(told.time, told.position, told.velocity, acceleration, flipped);
    EXPECT_THAT(says, HasSubstr("'q' changes -1 times as fast as 'qd' says"));
    EXPECT_THAT(says, HasSubstr("turn it with --roles 'qd=velocity[-1 rad/s]'"));
    EXPECT_THAT(says, HasSubstr(flipped ? "goes with 'qd', without --flip-sign"
                                        : "goes with 'qd', with --flip-sign"));
  }
}

// 60 is nearer than the 57.3 of degrees.
TEST(MotionCheck, MinutesAreNotDegrees) {
  Told told = sine(0);
  std::vector<double> acceleration;
  for (const double t : told.time) acceleration.push_back(-2.4 * std::sin(2 * t));
  for (double& t : told.time) t /= 60;
  EXPECT_THAT(complaint_about(told.time, told.position, told.velocity, acceleration),
              HasSubstr("say --roles 't=time[min]'"));
}

TEST(MotionCheck, ASpreadsheetCountsInDays) {
  for (const auto& [seconds, unit] : {std::pair(3600.0, "'t=time[h]'"), {86400.0, "'t=time[d]'"}}) {
    Told told = sine(0);
    for (double& t : told.time) t /= seconds;
    const std::vector<double> acceleration(told.time.size(), 0.0);
    EXPECT_THAT(complaint_about(told.time, told.position, told.velocity, acceleration),
                HasSubstr(unit));
  }
}

TEST(MotionCheck, AJointThatTurnsOftenMayBeToldInDegrees) {
  const auto remark = [](double swing) {
    return remark_on_turns(parse_csv(
        fmt::format("t_s,position_rad,torque_Nm\n0,0,1\n1,{0},1\n2,-{0},1\n", swing), "d.csv"));
  };
  EXPECT_EQ(remark(1), std::nullopt);
  EXPECT_THAT(remark(60).value_or(""), HasSubstr("are degrees, 'position_rad=position[deg]'"));
  EXPECT_THAT(remark(60000).value_or(""), ::testing::Not(HasSubstr("degrees")));
}

// Noise is not another joint's motion: a joint that rests, and one whose columns are mostly noise.
TEST(MotionCheck, NoiseIsNotRefused) {
  RandomStream random(3);
  for (const double swing : {0.0, 0.02}) {
    std::vector<double> time, q, qd, qdd;
    for (int i = 0; i < 6000; ++i) {
      const double t = 0.002 * i;
      time.push_back(t);
      q.push_back(swing * std::sin(0.7 * t) + 0.003 * random.normal());
      qd.push_back(0.7 * swing * std::cos(0.7 * t) + 0.05 * random.normal());
      qdd.push_back(2 * random.normal());
    }
    EXPECT_EQ(complaint_about(time, q, qd, qdd), "no error") << swing;
  }
}

// Turns in a unit that the header names may be the motor's all the same: it is said, not refused.
TEST(MotionCheck, AJointThatTurnsOverAndOverMayBeTheMotor) {
  const auto remark = [](double turns, const char* column) {
    std::string text = fmt::format("t [s],{},qd [deg/s]\n", column);
    for (int i = 0; i < 400; ++i) {
      const double angle = turns * std::numbers::pi;
      text += fmt::format("{},{},{}\n", 0.01 * i, -angle * std::cos(0.02 * i) * 57.29578,
                          2 * angle * std::sin(0.02 * i) * 57.29578);
    }
    const DataFile file = parse_csv(text, "d.csv");
    check_motion(file, {});
    return remark_on_turns(file).value_or("");
  };
  EXPECT_THAT(remark(44, "q [deg]"),
              AllOf(HasSubstr("'q [deg]' ranges over 44 turns"), HasSubstr("position[deg@motor]"),
                    HasSubstr("--gear-ratio")));
  EXPECT_EQ(remark(1.9, "q [deg]"), "");
}

TEST(MotionCheck, ADelayIsFoundToATenthOfAStep) {
  const Told truth = sine(0);
  const std::vector<RowRange> whole = {{0, truth.time.size()}};
  for (const double delay : {0.0131, 0.004, -0.006, 0.05}) {
    const Told told = sine(delay);
    const auto found = delay_of(truth.time, truth.velocity, told.velocity, whole);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, delay, 2e-4);
  }
}

}  // namespace
}  // namespace tribench
