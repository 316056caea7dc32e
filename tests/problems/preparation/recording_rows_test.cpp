// SPDX-License-Identifier: MIT
//
// Rows as recorders spoil them: one clean joint, told with one fault at a time. What comes out is
// the clean one's motion.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "foundation/error.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kRecordingStep = 0.004;
constexpr double kTurn = 2 * M_PI;

struct Row {
  double time = 0;
  double position = 0;  // rad
  double torque = 0;
};

// Swings of up to 1.2 rad and 1.5 rad/s.
double place_at(double t) { return 0.55 * std::sin(1.36 * t) + 0.65 * std::sin(1.14 * t); }
double speed_at(double t) {
  return 0.55 * 1.36 * std::cos(1.36 * t) + 0.65 * 1.14 * std::cos(1.14 * t);
}

std::vector<Row> swings() {
  std::vector<Row> rows;
  for (int i = 0; i < 10'000; ++i) {
    const double t = kRecordingStep * i;
    const double v = speed_at(t);
    const double noise = 0.02 * std::sin(17.0 * i) + 0.02 * std::sin(5.3 * i * i);
    rows.push_back({t, place_at(t), (v > 0 ? 0.5 : -0.5) + 0.3 * v + noise});
  }
  return rows;
}

PreparedRecording prepared(const std::vector<Row>& rows, const char* unit = "rad", Drive drive = {},
                           int digits = 7) {
  std::string text = "t,pos,tau\n";
  for (const Row& row : rows) {
    text += fmt::format("{:.6f},{:.{}f},{:.4f}\n", row.time, row.position, digits, row.torque);
  }
  CsvOptions csv;
  csv.used.emplace();
  csv.drive = drive;
  csv.roles =
      parse_roles(fmt::format("t=time[s],pos=position[{}],tau=motor_torque[N m]", unit), "--roles");
  DataOptions options;
  options.drive = drive;
  return prepare(parse_csv(text, "log.csv", csv), options);
}

// The velocity that comes out, against the one of the clean rows at the same instants.
// late: by how much all of its stamps are.
void expect_same_motion(const PreparedRecording& recording, const char* note, double late = 0) {
  EXPECT_THAT(recording.notes, Contains(HasSubstr(note)));
  const std::vector<double>& t = recording.data.find(Role::time)->values;
  const std::vector<double>& v = recording.data.find(Role::velocity)->values;
  EXPECT_GT(t.size(),
            4000U);  // of 10 000: it swings too fast for a jittering clock in half of them
  double worst = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    worst = std::max(worst, std::abs(v[i] - speed_at(t[i] - late)));
  }
  EXPECT_LT(worst, 0.03) << note;
}

TEST(RecordingRows, AClockThatTicksMoreSlowlyThanTheRowsCome) {
  for (const double tick : {1.0, 1.0 / 64}) {  // whole seconds; Windows' clock
    std::vector<Row> rows = swings();
    for (Row& row : rows) row.time = tick * std::floor(row.time / tick);
    expect_same_motion(prepared(rows), "taken to be even in time", -tick / 2);
  }
  // Rows that come in bursts do not say when they were made.
  std::vector<Row> bursts = swings();
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    bursts[i].time = std::floor(std::sqrt(static_cast<double>(i)));
  }
  EXPECT_THROW(prepared(bursts), Error);
  // A few ticks do not say how fast the rows are: stamps since 1970 in single precision.
  std::vector<Row> single = swings();
  for (Row& row : single) row.time = 128 * std::floor((row.time + 120) / 128);
  EXPECT_THROW(prepared(single), Error);
}

TEST(RecordingRows, StampsThatJitterAboutASteadyBeat) {
  std::vector<Row> rows = swings();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time += 0.3 * kRecordingStep * std::sin(7.7 * static_cast<double>(i * i));
  }
  expect_same_motion(prepared(rows), "jitter by 0.85 ms about even instants");
}

// Rows that really were made at uneven instants, stamped rightly, are left as they are.
TEST(RecordingRows, StampsThatAreRightAreKept) {
  std::vector<Row> rows = swings();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    row.time += 0.4 * kRecordingStep * std::sin(7.7 * static_cast<double>(i * i));
    row.position = place_at(row.time);
  }
  const PreparedRecording recording = prepared(rows);
  EXPECT_THAT(recording.notes, Not(Contains(HasSubstr("jitter"))));
  expect_same_motion(recording, "velocity is derived");
}

TEST(RecordingRows, RowsAreLostAtRandom) {
  std::vector<Row> rows;
  for (const Row& row : swings()) {
    if (std::sin(5.1 * static_cast<double>(rows.size()) + 900 * row.time) < 0.8)
      rows.push_back(row);
  }
  ASSERT_LT(rows.size(), 9000U);
  expect_same_motion(prepared(rows), "velocity is derived");
}

TEST(RecordingRows, WrongReadingsAreLeftOutAndCounted) {
  std::vector<Row> rows = swings();
  for (const std::size_t i : {900U, 4000U, 4001U, 7321U}) rows[i].position = 0;
  for (const std::size_t i : {1500U, 6000U}) rows[i].torque = 300;
  const PreparedRecording recording = prepared(rows);
  expect_same_motion(recording, "have a wrong reading of 'pos'");
  EXPECT_THAT(recording.notes, Contains(HasSubstr("2 of 9996 rows have a wrong reading of 'tau'")));
  for (const double torque : recording.data.find(Role::motor_torque)->values) {
    ASSERT_LT(std::abs(torque), 2);
  }
}

TEST(RecordingRows, ATorqueThatStoodStillIsLeftOutAndSaid) {
  std::vector<Row> rows = swings();
  for (std::size_t i = 5001; i < 5500; ++i) rows[i].torque = rows[5000].torque;
  expect_same_motion(prepared(rows),
                     "499 of 10000 rows stand in a stretch of more than 50 over which 'tau' keeps "
                     "its value while the joint moves");
}

TEST(RecordingRows, APositionThatIsSetAnewHasNotMoved) {
  std::vector<Row> rows = swings();
  for (std::size_t i = 5000; i < rows.size(); ++i) rows[i].position += 3.3;
  expect_same_motion(prepared(rows), "and the joint goes on as before");
}

// Stamped again as one: each keeps its positions, and no motion leads from one to the next.
TEST(RecordingRows, RecordingsThatWerePutTogetherAreCutWhereTheOtherBegins) {
  const auto instant = [](double t) { return t < 16 ? t : t + 51.3; };
  std::vector<Row> rows = swings();
  for (Row& row : rows) {
    const double v = speed_at(instant(row.time));
    row.position = place_at(instant(row.time));
    if (row.time > 6 && row.time < 16) row.position += 1.7;  // the first was set anew on its way
    row.torque = (v > 0 ? 0.5 : -0.5) + 0.3 * v + 0.02 * std::sin(1e4 * row.time);
  }
  const PreparedRecording recording = prepared(rows);
  EXPECT_THAT(recording.notes, Contains(HasSubstr("recordings that were put together")));
  const std::vector<double>& t = recording.data.find(Role::time)->values;
  ASSERT_GT(t.size(), 5000U);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double near = t[i] > 6 && t[i] < 16 ? 1e-4 : 1e-6;
    ASSERT_NEAR(recording.data.find(Role::position)->values[i], place_at(instant(t[i])), near);
    ASSERT_NEAR(recording.data.find(Role::velocity)->values[i], speed_at(instant(t[i])), 0.03);
    if (i == 0 || t[i - 1] >= 16 || t[i] < 16) continue;
    EXPECT_NE(recording.data.movement[i], recording.data.movement[i - 1]);
  }
}

// 4 096 counts a turn of the motor in a counter of 16 bits; one turn of the motor in degrees.
TEST(RecordingRows, CountersAndTurnsThatStartAgainAreLaidEndToEnd) {
  const Drive drive{4096.0, 100.0};
  const auto wrapped = [](double x, double full) { return x - full * std::floor(x / full); };
  std::vector<Row> counts = swings();
  for (Row& row : counts) {
    const double count = std::floor(row.position * 100 / kTurn * 4096);
    row.position = wrapped(count, 65536) - 32768;
  }
  expect_same_motion(prepared(counts, "counts@motor", drive, 0), "laid end to end");
  std::vector<Row> turns = swings();
  for (Row& row : turns) row.position = wrapped(row.position * 100 * 360 / kTurn, 360);
  expect_same_motion(prepared(turns, "deg@motor", drive, 3), "laid end to end");
  // Where messages are lost the joint goes on: here by more than a turn of the motor.
  std::vector<Row> lost;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (i % 2000 < 1900 || i % 2000 > 1912) lost.push_back(turns[i]);
  }
  expect_same_motion(prepared(lost, "deg@motor", drive, 3), "laid end to end");
}

// Movements that begin elsewhere than the last one ended, some of them by as much: no counter.
TEST(RecordingRows, MovementsThatBeginElsewhereAreNotLaidEndToEnd) {
  std::string text = "q_deg,dq_deg_s,tau_Nm\n";
  const double ends[] = {0.6, -0.4, 0.6, 0.2, 0.6, -0.55, 0.1};
  for (const double end : ends) {
    for (int i = 0; i < 800; ++i) {
      const double phase = (kTurn + std::asin(end)) * i / 799;
      const double v = std::cos(phase);
      text += std::to_string(std::sin(phase) * 360 / kTurn) + "," +
              std::to_string(v * 360 / kTurn) + "," + std::to_string(v > 0 ? 5.0 : -5.0) + "\n";
    }
  }
  CsvOptions csv;
  csv.used.emplace();
  const PreparedRecording recording = prepare(parse_csv(text, "log.csv", csv), {});
  EXPECT_THAT(recording.notes, Not(Contains(HasSubstr("laid end to end"))));
}

// The counter's span is as exact as its count, which is a billionth of it.
TEST(RecordingRows, ACounterOf32BitsIsLaidEndToEndToTheCount) {
  std::vector<Row> rows = swings();
  for (Row& row : rows) {
    const double count = std::floor(row.position * 100 / kTurn * 4096);
    row.position = count - 4294967296.0 * std::floor(count / 4294967296.0);
  }
  const PreparedRecording recording = prepared(rows, "counts@motor", Drive{4096.0, 100.0}, 0);
  expect_same_motion(recording, "laid end to end");
  const std::vector<double>& t = recording.data.find(Role::time)->values;
  const std::vector<double>& q = recording.data.find(Role::position)->values;
  for (std::size_t i = 0; i < t.size(); ++i) {
    ASSERT_NEAR(q[i] - q[0], place_at(t[i]) - place_at(t[0]), 3e-5) << i;
  }
}

// For so long that a joint which speeds up goes another way than straight on, by half a turn of its
// motor: the speed behind the gap tells. By the position alone, and with a measured velocity.
TEST(RecordingRows, ATurnThatEndsAmongLostMessagesIsCountedByTheSpeedOnBothSides) {
  for (const bool with_velocity : {false, true}) {
    std::string text = with_velocity ? "t,pos,tau,vel\n" : "t,pos,tau\n";
    for (const Row& row : swings()) {
      const auto number = static_cast<std::size_t>(std::lround(row.time / kRecordingStep));
      if (number % 400 > 325) continue;
      const double degrees = row.position * 100 * 360 / kTurn;
      text += fmt::format("{:.6f},{:.3f},{:.4f}", row.time,
                          degrees - 360 * std::floor(degrees / 360), row.torque);
      text += with_velocity ? fmt::format(",{:.5f}\n", speed_at(row.time)) : "\n";
    }
    CsvOptions csv;
    csv.used.emplace();
    csv.drive = {{}, 100.0};
    csv.roles = parse_roles(fmt::format("t=time[s],pos=position[deg@motor],tau=motor_torque[N m]{}",
                                        with_velocity ? ",vel=velocity[rad/s]" : ""),
                            "--roles");
    DataOptions options;
    options.drive = csv.drive;
    const PreparedRecording recording = prepare(parse_csv(text, "log.csv", csv), options);
    const std::vector<double>& t = recording.data.find(Role::time)->values;
    const std::vector<double>& q = recording.data.find(Role::position)->values;
    ASSERT_GT(t.size(), 4000U);
    double worst = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      worst = std::max(worst, std::abs(q[i] - place_at(t[i]) - (q[0] - place_at(t[0]))));
    }
    EXPECT_LT(worst, 0.01) << with_velocity;
  }
}

// Degrees of the motor under a name that says nothing of it: a joint would turn 20 times over.
TEST(RecordingRows, ASideOfTheGearThatNobodyNamesIsAskedFor) {
  std::string text = "t [s],angle [deg],tau [Nm]\n";
  for (const Row& row : swings()) {
    text += fmt::format("{:.3f},{:.4f},{:.4f}\n", row.time, row.position * 50 * 360 / kTurn,
                        row.torque);
  }
  CsvOptions csv;
  csv.drive.gear_ratio = 50;
  DataOptions options;
  options.drive = csv.drive;
  try {
    prepare(parse_csv(text, "log.csv", csv), options);
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing says on which side of the gear"));
    EXPECT_THAT(error.what(), HasSubstr("--roles 'angle [deg]=position[deg@motor]'"));
  }
  csv.roles = parse_roles("angle [deg]=position[deg@motor]", "--roles");
  expect_same_motion(prepare(parse_csv(text, "log.csv", csv), options), "velocity is derived");
}

TEST(RecordingRows, ALogWithoutATimeIsSaidToBeOne) {
  std::string text = "pos,vel,tau\n";
  for (const Row& row : swings()) {
    text += fmt::format("{:.6f},{:.5f},{:.4f}\n", row.position, speed_at(row.time), row.torque);
  }
  CsvOptions csv;
  csv.roles = parse_roles("pos=position[rad],vel=velocity[rad/s],tau=motor_torque[N m]", "--roles");
  EXPECT_THAT(prepare(parse_csv(text, "log.csv", csv), {}).notes,
              Contains(HasSubstr("no column is the time")));
  csv.sample_rate = 1 / kRecordingStep;
  expect_same_motion(prepare(parse_csv(text, "log.csv", csv), {}), "--sample-rate");
}

TEST(RecordingRows, AVelocityThatNobodyFilledIsRefusedWithTheMend) {
  std::string text = "t_s,pos_rad,vel_rad_s,tau_Nm\n";
  for (const Row& row : swings()) {
    text += fmt::format("{:.3f},{:.6f},0.0,{:.4f}\n", row.time, row.position, row.torque);
  }
  try {
    prepare(parse_csv(text, "log.csv"), {});
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("--roles 'vel_rad_s=none'"));
  }
}

}  // namespace
}  // namespace tribench
