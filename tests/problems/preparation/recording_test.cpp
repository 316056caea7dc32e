// SPDX-License-Identifier: MIT
#include "problems/preparation/recording.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "problems/joint_simulation/controlled_run.hpp"
#include "tests/problems/preparation/raw_log.hpp"

namespace tribench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::RawLogPlan;
using testing::RawSample;
using testing::RawTelling;

DataOptions engineer() {
  DataOptions options;
  options.torque_constant = TorqueConstant{8, false};
  return options;
}

CsvOptions csv_of(const DataOptions& options) {
  CsvOptions csv;
  csv.roles = options.roles;
  csv.drive = options.drive;
  csv.used = std::vector<std::string>{};
  return csv;
}

PreparedRecording prepared(const std::string& text, const DataOptions& options,
                           Gravity gravity = Gravity::automatic) {
  return prepare(parse_csv(text, "log.csv", csv_of(options)), options, gravity);
}

std::string complaint(const std::string& text, const DataOptions& options,
                      Gravity gravity = Gravity::automatic) {
  try {
    prepared(text, options, gravity);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

double rms_against_truth(const PreparedRecording& recording, const std::vector<RawSample>& truth,
                         Role role, double RawSample::*member, double step) {
  const std::vector<double>& values = recording.data.find(role)->values;
  const std::vector<double>& time = recording.data.find(Role::time)->values;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto place = static_cast<std::size_t>(std::lround(time[i] / step));
    const double e = values[i] - truth[place].*member;
    sum += e * e;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(PreparedRecording, PositionAndCurrentAloneBecomeTorqueVelocityAndStrokes) {
  RawLogPlan plan;
  const std::vector<RawSample> truth = simulate(plan);
  const PreparedRecording recording = prepared(raw_table(truth, plan, {}), engineer());
  const Dataset& data = recording.data;
  ASSERT_NE(data.find(Role::velocity), nullptr);
  EXPECT_EQ(data.find(Role::motor_torque)->unit, "N m");
  EXPECT_LT(rms_against_truth(recording, truth, Role::velocity, &RawSample::velocity, plan.step),
            0.005);
  // Ramps are left out; what is left goes straight on.
  EXPECT_GT(recording.unresolved, 0U);
  EXPECT_THAT(recording.notes, Contains(HasSubstr(std::to_string(recording.unresolved) + " of ")));
  EXPECT_THAT(recording.notes, Contains(HasSubstr("no inertia can be told")));
  // Strokes are the movements that were made, give or take those at either end.
  const int made = truth.back().movement > 0 ? truth.back().movement : 20;
  EXPECT_NEAR(static_cast<double>(data.movement_names.size()), made, 0.15 * made);
  for (std::size_t i = 1; i < data.rows(); ++i) {
    if (data.movement[i] != data.movement[i - 1]) continue;
    ASSERT_GT(data.find(Role::velocity)->values[i] * data.find(Role::velocity)->values[i - 1],
              -1e-5);
  }
}

// The movements that a table does not name are found in it, whoever derived its motion.
TEST(PreparedRecording, ATableWithAllOfItsMotionIsCutIntoStrokesToo) {
  std::ostringstream table;
  write_csv(simulation::run_under_control({}, 1).data, table);
  const std::string named = table.str();
  std::string unnamed = named;
  unnamed.replace(unnamed.find("movement"), 8, "run_name");
  const PreparedRecording cut = prepared(unnamed, {});
  EXPECT_GT(cut.data.movement_names.size(), 10U);
  EXPECT_THAT(cut.notes, Contains(HasSubstr("no column names the movements")));
  // What a column names is what it is.
  EXPECT_EQ(prepared(named, {}).data.movement_names.size(), 1U);
}

TEST(PreparedRecording, TheOtherJointsAccelerationFollowsFromItsVelocity) {
  std::string text = "t,q,i_A,other_velocity\n";
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.005 * k;
    text += fmt::format("{:.3f},{:.7f},{:.5f},{:.6f}\n", t, std::sin(t),
                        std::cos(t) > 0 ? 1.0 : -1.0, 0.8 * std::sin(3 * t));
  }
  const PreparedRecording recording = prepared(text, engineer());
  const Channel* a2 = recording.data.find(Role::other_acceleration);
  ASSERT_NE(a2, nullptr);
  EXPECT_EQ(a2->unit, "rad/s^2");
  EXPECT_THAT(recording.notes, Contains(HasSubstr("other joint's acceleration is derived")));
  const std::vector<double>& time = recording.data.find(Role::time)->values;
  for (std::size_t i = 0; i < time.size(); ++i) {
    ASSERT_NEAR(a2->values[i], 2.4 * std::cos(3 * time[i]), 0.03) << time[i];
  }
}

TEST(PreparedRecording, GravityThatNoColumnDeclaresIsFound) {
  RawLogPlan plan;
  plan.load = 0.08;
  const PreparedRecording recording = prepared(raw_table(simulate(plan), plan, {}), engineer());
  const Channel* load = recording.data.find(Role::gravity_torque);
  ASSERT_NE(load, nullptr);
  const std::vector<double>& q = recording.data.find(Role::position)->values;
  for (std::size_t i = 0; i < q.size(); i += 100) {
    EXPECT_NEAR(load->values[i], plan.gravity * std::sin(q[i]), 0.03 * plan.gravity);
  }
  EXPECT_THAT(recording.rigid, Contains("sin_q"));
  EXPECT_THAT(recording.notes, Contains(HasSubstr("--gravity fit")));
  plan.gravity = 0;
  EXPECT_EQ(
      prepared(raw_table(simulate(plan), plan, {}), engineer()).data.find(Role::gravity_torque),
      nullptr);
}

TEST(PreparedRecording, AFilteredVelocityIsKnownByItsDelay) {
  RawLogPlan plan;
  RawTelling telling;
  telling.velocity = true;
  const std::vector<RawSample> truth = simulate(plan);
  const PreparedRecording recording = prepared(raw_table(truth, plan, telling), engineer());
  EXPECT_THAT(recording.notes, Contains(HasSubstr("lags behind its position by")));
  EXPECT_LT(rms_against_truth(recording, truth, Role::velocity, &RawSample::velocity, plan.step),
            0.005);
  plan.velocity_filter = 0;
  telling.velocity = true;
  const PreparedRecording plain = prepared(raw_table(simulate(plan), plan, telling), engineer());
  EXPECT_THAT(plain.notes, Not(Contains(HasSubstr("lags behind"))));
}

// A drive that sends its speed in steps of 0.05 rad/s knows less of it than its encoder.
TEST(PreparedRecording, ACoarseVelocityGivesWayToWhatItsPositionSays) {
  RawLogPlan plan;
  plan.seconds = 30;
  const std::vector<RawSample> truth = simulate(plan);
  const auto told = [&](double count) {
    std::string text = "time_s,position_rad,velocity_rad_s,torque_Nm\n";
    for (const RawSample& one : truth) {
      text += fmt::format("{:.4f},{:.5f},{:.6f},{:.3f}\n", one.time, one.position,
                          count * std::round(one.velocity / count), one.torque);
    }
    return prepared(text, {});
  };
  const PreparedRecording coarse = told(0.05);
  EXPECT_TRUE(coarse.derived_velocity);
  EXPECT_THAT(coarse.notes, Contains(HasSubstr("is told in steps of 0.05")));
  EXPECT_LT(rms_against_truth(coarse, truth, Role::velocity, &RawSample::velocity, plan.step),
            0.005);
  EXPECT_FALSE(told(1e-6).derived_velocity);
}

// Neighbouring counts over a millisecond: rounded as it is written, it has no steps any more.
TEST(PreparedRecording, AVelocityFromTheDifferencesOfCountsGivesWayToo) {
  RawLogPlan plan;
  plan.seconds = 30;
  plan.step = 0.001;
  const std::vector<RawSample> truth = simulate(plan);
  const auto told = [&](double count) {
    const auto position = [&](std::size_t i) {
      return count * std::round(truth[i].position / count);
    };
    std::string text = "time_s,position_rad,velocity_rad_s,torque_Nm\n";
    for (std::size_t i = 1; i + 1 < truth.size(); ++i) {
      const double rounding = 1e-6 * std::sin(static_cast<double>(i * i));
      const double v = (position(i + 1) - position(i - 1)) / (2 * plan.step) + rounding;
      text += fmt::format("{:.4f},{:.7f},{:.8f},{:.3f}\n", truth[i].time, position(i), v,
                          truth[i].torque);
    }
    return prepared(text, {});
  };
  const PreparedRecording noisy = told(4e-4);
  EXPECT_TRUE(noisy.derived_velocity);
  EXPECT_THAT(noisy.notes, Contains(HasSubstr("has a noise of 0.")));
  EXPECT_LT(rms_against_truth(noisy, truth, Role::velocity, &RawSample::velocity, plan.step), 0.01);
}

// Every way of telling one physics gives the same channels.
TEST(PreparedRecording, TellingsOfOnePhysicsAgree) {
  RawLogPlan plan;
  const std::vector<RawSample> truth = simulate(plan);
  DataOptions options = engineer();
  options.drive.counts_per_turn = 65536;
  const PreparedRecording first = prepared(raw_table(truth, plan, {}), options);
  for (const RawTelling telling :
       {RawTelling{.counts = true}, RawTelling{.decimal_comma = true},
        RawTelling{.decimal_comma = true, .units_row = true}, RawTelling{.units_row = true}}) {
    const PreparedRecording other = prepared(raw_table(truth, plan, telling), options);
    ASSERT_EQ(other.data.rows(), first.data.rows());
    for (const Role role : {Role::velocity, Role::motor_torque, Role::position}) {
      for (std::size_t i = 0; i < first.data.rows(); i += 50) {
        EXPECT_NEAR(other.data.find(role)->values[i], first.data.find(role)->values[i], 2e-3);
      }
    }
  }
}

// How many rows of a log are faster than `least` rad/s, of a joint that its gear's ripple shakes by
// so much at half a radian a second.
std::size_t fast_rows(double shake, double least) {
  RawLogPlan plan;
  plan.seconds = 120;
  plan.encoder_bits = 18;
  std::vector<RawSample> samples = simulate(plan);
  constexpr double kRipple = 60;  // rad for one of the joint
  for (RawSample& sample : samples) {
    const double ratio = sample.velocity / 0.5;
    sample.position += shake / (1 + ratio * ratio) * std::cos(kRipple * sample.position);
  }
  const PreparedRecording log = prepared(raw_table(samples, plan, {}), engineer());
  return static_cast<std::size_t>(
      std::ranges::count_if(log.data.find(Role::velocity)->values,
                            [&](double speed) { return std::abs(speed) > least; }));
}

// What shakes a joint all along a stroke is no ramp: fast strokes are kept, and with them what
// friction does at speed.
TEST(PreparedRecording, AJointThatItsGearShakesKeepsItsFastStrokes) {
  const std::size_t calm = fast_rows(0, 0.3);
  ASSERT_GT(calm, 2000U);
  EXPECT_GT(fast_rows(0.001, 0.3), calm * 3 / 4);
}

TEST(PreparedRecording, LostMessagesCutTheRecordingAndNothingIsDrawnThroughThem) {
  RawLogPlan plan;
  const std::vector<RawSample> truth = simulate(plan);
  const PreparedRecording recording =
      prepared(raw_table(truth, plan, {.losses = true}), engineer());
  EXPECT_LT(rms_against_truth(recording, truth, Role::velocity, &RawSample::velocity, plan.step),
            0.005);
}

// The same numbers in a unit that nobody said.
std::string told_wrong(double position, double velocity, double time) {
  std::string text = "time,q,dq,tau_m\n";
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.005 * i;
    const double q = 0.5 * std::sin(t);
    const double v = 0.5 * std::cos(t);
    text += std::to_string(t * time) + "," + std::to_string(q * position) + "," +
            std::to_string(v * velocity) + "," +
            std::to_string((v > 0 ? 5 : -5) + 3 * v + 0.01 * std::sin(17.0 * i)) + "\n";
  }
  return text;
}

TEST(PreparedRecording, AStoryThatIsNotPossibleIsRefusedWithTheMend) {
  const DataOptions options;
  EXPECT_EQ(complaint(told_wrong(1, 1, 1), options), "no error");
  EXPECT_THAT(complaint(told_wrong(57.29578, 1, 1), options), HasSubstr("q=position[deg]"));
  EXPECT_THAT(complaint(told_wrong(1, 57.29578, 1), options), HasSubstr("dq=velocity[deg/s]"));
  EXPECT_THAT(complaint(told_wrong(1, 9.549297, 1), options), HasSubstr("dq=velocity[rpm]"));
  EXPECT_THAT(complaint(told_wrong(1, 1, 1000), options), HasSubstr("time=time[ms]"));
  EXPECT_THAT(complaint(told_wrong(1, -1, 1), options),
              ::testing::AllOf(HasSubstr("sign turned"), HasSubstr("'dq=velocity[-1 rad/s]'")));
  DataOptions derived;
  derived.roles = parse_roles("dq=none", "--roles");
  EXPECT_THAT(complaint(told_wrong(1, 1, 1e3), derived), HasSubstr("time=time[ms]"));
  EXPECT_THAT(complaint(told_wrong(1, 1, 1e6), derived), HasSubstr("time=time[us]"));
  // Both in degrees agree with one another; the range of motion does not agree with radians.
  EXPECT_THAT(complaint(told_wrong(57.29578, 57.29578, 1), options), HasSubstr("q=position[deg]"));
  DataOptions geared;
  geared.drive.gear_ratio = 100;
  EXPECT_THAT(complaint(told_wrong(1, 100, 1), geared), HasSubstr("velocity[rad/s@motor]"));
  EXPECT_THAT(complaint(told_wrong(1, 954.9297, 1), geared), HasSubstr("velocity[rpm@motor]"));
  // A unit that was said stays.
  geared.roles = parse_roles("dq=velocity[rpm]", "--roles");
  EXPECT_THAT(complaint(told_wrong(1, 954.9297, 1), geared), HasSubstr("velocity[rpm@motor]"));
}

TEST(PreparedRecording, AUnitThatWasSaidWrongIsMendedByTheOneThatFits) {
  DataOptions options;
  options.roles = parse_roles("dq=velocity[deg/s]", "--roles");
  EXPECT_THAT(complaint(told_wrong(1, 9.549297, 1), options), HasSubstr("dq=velocity[rpm]"));
  EXPECT_THAT(complaint(told_wrong(1, 1, 1), options),
              HasSubstr("'q=position[deg]' or 'dq=velocity[rad/s]'"));
  options.roles = parse_roles("q=position[rev]", "--roles");
  EXPECT_THAT(complaint(told_wrong(57.29578, 1, 1), options), HasSubstr("q=position[deg]"));
  options.roles = parse_roles("time=time[ms]", "--roles");
  EXPECT_THAT(complaint(told_wrong(1, 1, 1e6), options), HasSubstr("time=time[us]"));
}

TEST(PreparedRecording, ASlideBesideItsMotorsSpeedIsRefusedWithTheScrewsLead) {
  DataOptions options;  // 20 mm a turn
  options.roles = parse_roles("q=position[mm],dq=velocity[rpm]", "--roles");
  EXPECT_THAT(complaint(told_wrong(1000, 3000, 1), options),
              ::testing::AllOf(HasSubstr("(20 mm a turn)"), HasSubstr("'dq=none'")));
  options.roles = parse_roles("q=position[mm],dq=none", "--roles");
  EXPECT_EQ(complaint(told_wrong(1000, 3000, 1), options), "no error");
}

// A bus's 0x10 is a cell's way of writing, not a person's.
TEST(PreparedRecording, ATorqueConstantIsADecimalNumber) {
  EXPECT_EQ(parse_torque_constant("0.07@motor", "here").value, 0.07);
  for (const char* text : {"0x10", "1,5", "nan", "-2", ""}) {
    EXPECT_THROW(parse_torque_constant(text, "here"), Error) << text;
  }
}

TEST(PreparedRecording, DifferentUnitsAreNeverSubtracted) {
  RawLogPlan plan;
  const std::string text = raw_table(simulate(plan), plan, {.gravity = true});
  EXPECT_THAT(complaint(text, {}), HasSubstr("--torque-constant"));
  EXPECT_EQ(complaint(text, engineer()), "no error");
  DataOptions wrong = engineer();
  wrong.torque_constant->value = 8000;
  EXPECT_THAT(complaint(text, wrong), HasSubstr("with the factor"));
  // At the motor, and nobody said so.
  wrong.torque_constant->value = 8.0 / 160;
  EXPECT_THAT(complaint(text, wrong), HasSubstr("side of the gear (@motor)"));
  // A payload that nobody declared, or a constant that is somewhat off, is a story.
  wrong.torque_constant->value = 12;
  EXPECT_EQ(complaint(text, wrong), "no error");
}

TEST(PreparedRecording, AllThatIsMissingIsSaidAtOnce) {
  const std::string text = "stamp,pos,cur\n0,1,2\n1,2,3\n";
  const std::string said = complaint(text, {});
  for (const char* word : {"unit of 'stamp'", "unit of 'pos'", "unit of 'cur'",
                           "stamp=time[?],pos=position[?],cur=motor_current[?]"}) {
    EXPECT_THAT(said, HasSubstr(word));
  }
}

TEST(PreparedRecording, FrictionThatOpposesTheVelocityIsSeenBesideGravity) {
  RawLogPlan plan;
  std::vector<RawSample> truth = simulate(plan);
  for (RawSample& sample : truth) sample.torque = -sample.torque;
  EXPECT_THAT(complaint(raw_table(truth, plan, {}), engineer()), HasSubstr("give --flip-sign"));
  DataFile turned = parse_csv(raw_table(simulate(plan), plan, {}), "log.csv", csv_of(engineer()));
  flip_torques(turned.data);
  try {
    prepare(turned, engineer());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.mend(), "leave --flip-sign out: it is what turned the torques' sign");
  }
}

TEST(PreparedRecording, ACurrentAtItsLimitIsLeftOutAndCounted) {
  RawLogPlan plan;
  std::vector<RawSample> truth = simulate(plan);
  std::size_t clipped = 0;
  for (RawSample& sample : truth) {
    clipped += sample.torque > 14 ? 1 : 0;
    sample.torque = std::min(sample.torque, 14.0);
  }
  ASSERT_GT(clipped, 100U);
  EXPECT_THAT(prepared(raw_table(truth, plan, {}), engineer()).notes,
              Contains(HasSubstr("at its limit")));
}

// Half sines from rest to rest in one movement each, to `ends` one after the other; the joint rests
// where it has come to.
std::string strokes_to(std::span<const double> ends) {
  std::string text = "movement,time_s,position_rad,velocity_rad_s,torque_Nm\n";
  double time = 0;
  double place = 0;
  for (std::size_t m = 0; m < ends.size(); ++m) {
    const double way = ends[m] - place;
    for (int i = 0; i <= 200; ++i) {
      const double phase = 3.14159265358979 * i / 200;
      text += fmt::format("{},{:.2f},{:.9f},{:.9f},{}\n", m, time + 0.01 * i,
                          place + way * (1 - std::cos(phase)) / 2,
                          way * 3.14159265358979 / 4 * std::sin(phase), 2 + 0.01 * (i * 37 % 11));
    }
    time += 5;
    place = ends[m];
  }
  return text;
}

// Told or derived, the inertia of a motor torque is no effect that friction lacks.
TEST(PreparedRecording, AnInertiaIsInTheBaseWhetherItsAccelerationIsToldOrNot) {
  const auto swing = [](bool told) {
    std::string text = told ? "t,q,v,tau,g,a\n" : "t,q,v,tau,g\n";
    for (int k = 0; k < 4000; ++k) {
      const double t = 0.005 * k;
      const double a = -std::sin(t);
      const double g = 3 * std::sin(std::sin(t));
      text += fmt::format("{:.3f},{:.7f},{:.7f},{:.6f},{:.6f}", t, std::sin(t), std::cos(t),
                          (std::cos(t) > 0 ? 1.0 : -1.0) + 0.7 * a + g, g);
      text += told ? fmt::format(",{:.6f}\n", a) : "\n";
    }
    DataOptions options;
    options.roles = parse_roles("tau=motor_torque[Nm],g=gravity_torque[Nm]", "--roles");
    return prepared(text, options).rigid;
  };
  EXPECT_THAT(swing(false), Contains("derived_acceleration"));
  EXPECT_THAT(swing(true), Contains("a"));
}

// Straight ways to and fro: the speed turns within a few rows, which are left out; of what is left
// the acceleration is the noise of the position.
TEST(PreparedRecording, AnAccelerationThatIsNoiseTellsNoInertia) {
  std::string text = "time_s,position_rad,torque_Nm\n";
  RandomStream random(key_of("straight"));
  double q = 0;
  for (int i = 0; i < 9000; ++i) {
    const double direction = (i / 300) % 2 == 0 ? 1 : -1;
    q += direction * 0.003 * (1 + 0.2 * ((i / 600) % 5));
    text += fmt::format("{:.2f},{:.9f},{:.6f}\n", 0.01 * i, q + 1e-5 * random.normal(),
                        2 * direction + 0.1 * random.normal());
  }
  const PreparedRecording recording = prepared(text, {});
  EXPECT_EQ(recording.data.find(Role::acceleration), nullptr);
  EXPECT_THAT(recording.rigid, ::testing::Not(Contains("derived_acceleration")));
  EXPECT_THAT(recording.notes, Contains(HasSubstr("no inertia can be told")));
}

// Nothing has turned where the joint goes on from where it rested: whether the bristles stayed bent
// is for the data to say.
TEST(PreparedRecording, AStrokeThatGoesOnWhereTheLastOneEndedHasSeenNoReversal) {
  DataOptions options;
  options.roles = parse_roles("torque_Nm=friction_torque", "--roles");
  const PreparedRecording recording =
      prepared(strokes_to(std::array{0.5, 1.0, 0.5, 0.0, 0.5}), options);
  const std::vector<double>& d = recording.data.at("d (derived)").values;
  const std::vector<double>& seen = recording.data.at("d_seen (derived)").values;
  const double farthest = 0.5;  // a stroke's whole way, before its slow end is cut off
  for (std::size_t i = 0; i < d.size(); ++i) {
    const int m = recording.data.movement[i];
    EXPECT_NEAR(seen[i], m == 1 || m == 3 ? farthest : d[i], 1e-9) << m;
  }
}

// Two movements named by a column: one from rest to 1 rad/s and back to rest, and after two seconds
// one that creeps with a hundredth of it from one place to another.
std::string told_movements() {
  std::string text = "movement,time_s,position_rad,velocity_rad_s,acceleration_rad_s2,torque_Nm\n";
  double position = 0;
  for (int i = 0; i < 800; ++i) {
    const bool creeps = i >= 400;
    const int k = i % 400;
    const double phase = 3.14159265358979 * k / 399;
    const double speed = creeps ? 0.01 : std::sin(phase);
    const double change = creeps ? 0 : std::cos(phase) * 3.14159265358979 / 3.99;
    position += 0.01 * speed;
    text += fmt::format("{},{:.2f},{:.9f},{},{},{}\n", creeps ? "slow" : "fast",
                        0.01 * i + (creeps ? 2 : 0), position, speed, change,
                        2 + speed + 0.01 * (i * 37 % 11));
  }
  return text;
}

TEST(PreparedRecording, DeclaredMovementsLoseRowsAtRestsAndReversalsAndKeepACreepingStroke) {
  DataOptions options;
  options.roles = parse_roles("torque_Nm=friction_torque", "--roles");
  const PreparedRecording recording = prepared(told_movements(), options);
  ASSERT_EQ(recording.data.movement_names, (std::vector<std::string>{"fast", "slow"}));
  // All but the first 1 mrad, of which the joint may have turned.
  EXPECT_EQ(std::ranges::count(recording.data.movement, 1), 389);
  const std::vector<double>& v = recording.data.find(Role::velocity)->values;
  const std::vector<double>& d = recording.data.at("d (derived)").values;
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_GE(d[i], 0.0010);  // 4e-4 of 2.54 rad
    if (recording.data.movement[i] == 0) {
      EXPECT_GE(v[i], 0.02);
    }
  }
  // Told by the rows that are gone too.
  EXPECT_NEAR(d.front(), 0.001181, 1e-6);  // by hand: five steps from rest
  EXPECT_THAT(recording.notes, Contains(HasSubstr("of 800 rows, at rest, slower than 0.02 rad/s, "
                                                  "nearer than 0.001 rad to a reversal")));
  const PreparedRecording whole = prepare(parse_csv(told_movements(), "log.csv", csv_of(options)),
                                          options, Gravity::automatic, SlowRows::kept);
  EXPECT_EQ(whole.data.rows(), 800U);
}

}  // namespace
}  // namespace tribench
