// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "problems/preparation/recording_steps.hpp"

namespace tribench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kStep = 0.01;

// So many times there and back at a speed of its own, a rest after each.
PreparedRecording swings_with_rests(int swings) {
  PreparedRecording out;
  Channel time{"t", "s", Role::time, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  for (int k = 0; k < swings; ++k) {
    const double speed = 0.2 + 0.1 * k;
    for (int i = 0; i < 500; ++i) {
      const double t = kStep * i;
      time.values.push_back(kStep * static_cast<double>(time.values.size()));
      velocity.values.push_back(t < 2 ? speed : t < 4 ? -speed : 0);
    }
  }
  out.data.channels = {time, velocity};
  out.data.movement.assign(time.values.size(), 0);
  out.data.movement_names = {"log"};
  return out;
}

// What a stroke at one speed shows would be an offset of its own.
TEST(RecordingMovements, WhatLiesBetweenRestsIsOneMovementWhereThoseAreEnough) {
  PreparedRecording ten = swings_with_rests(10);
  cut_strokes(ten, 0, 0);
  EXPECT_EQ(ten.data.movement_names.size(), 10U);
  EXPECT_THAT(ten.notes, Contains(HasSubstr("20 strokes between 10 rests")));
  PreparedRecording four = swings_with_rests(4);
  cut_strokes(four, 0, 0);
  EXPECT_EQ(four.data.movement_names.size(), 8U);
}

// Movements that begin and end in motion, each with a clock of its own; in this order.
PreparedRecording cut_out_of_motion(const std::vector<int>& order) {
  PreparedRecording out;
  Channel time{"t", "s", Role::time, {}};
  Channel position{"q", "rad", Role::position, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  for (const int m : order) {
    double q = 0.1 * m;
    for (int i = 0; i < 600; ++i) {
      const double v = i < 200 ? 0.3 + 0.1 * m : i < 300 ? 0 : i < 400 ? -0.004 * (i - 300) : 0.5;
      q += kStep * v;
      time.values.push_back(kStep * i);
      position.values.push_back(q);
      velocity.values.push_back(v);
      out.data.movement.push_back(m);
    }
  }
  out.data.channels = {time, position, velocity};
  out.data.movement_names = {"a", "b", "c"};
  return out;
}

// Of one movement, in the order of its rows.
std::vector<double> distances_in(const PreparedRecording& recording, int movement) {
  std::vector<double> values;
  const Channel& distance = recording.data.at(loop::derived_channel_name("d"));
  for (std::size_t i = 0; i < recording.data.rows(); ++i) {
    if (recording.data.movement[i] == movement) values.push_back(distance.values[i]);
  }
  return values;
}

TEST(RecordingMovements, AMovementDoesNotGoOnWhereAnotherHasEnded) {
  PreparedRecording one = cut_out_of_motion({0, 1, 2});
  PreparedRecording other = cut_out_of_motion({2, 0, 1});
  sort_movements(other);  // the clocks overlap: they stay as they stand
  settle_strokes(one, 0);
  settle_strokes(other, 0);
  ASSERT_LT(one.data.rows(), 1800U);
  for (const int m : {0, 1, 2}) EXPECT_EQ(distances_in(one, m), distances_in(other, m)) << m;
}

// The slowest row of a fast start may be fast: at rest it was a row before.
TEST(RecordingMovements, AStrokeStartsFromRestWhereItsRowsAreTooFarApartToShowIt) {
  PreparedRecording out;
  Channel time{"t", "s", Role::time, {}};
  Channel position{"q", "rad", Role::position, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  for (int m = 0; m < 4; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    double q = -s;
    for (int i = 0; i < 200; ++i) {
      const double v = s * std::min(1.0, 0.06 * (i + 1));
      time.values.push_back(kStep * (i + 300 * m));
      position.values.push_back(q);
      velocity.values.push_back(v);
      q += kStep * v;
      out.data.movement.push_back(m);
    }
    out.data.movement_names.push_back("stroke");
  }
  out.data.channels = {time, position, velocity};
  settle_strokes(out, 0);
  for (int m = 0; m < 4; ++m) {
    const std::vector<double> distances = distances_in(out, m);
    ASSERT_LT(distances.size(), 200U);  // without the first, nearer than bristles may need
    EXPECT_LT(distances.front(), 0.01);
    EXPECT_NEAR(distances.back(), 1.9, 0.1);
  }
}

// There and back at one speed, a movement each, in this order; their first rows are in motion, as
// those are of which a derived motion has lost its ends. pause: s between two.
PreparedRecording there_and_back(const std::vector<int>& order, double pause) {
  PreparedRecording out;
  Channel time{"t", "s", Role::time, {}};
  Channel position{"q", "rad", Role::position, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  for (const int m : order) {
    const double s = m % 2 == 0 ? 1 : -1;
    for (int i = 0; i < 200; ++i) {
      time.values.push_back(kStep * i + (200 * kStep + pause) * m);
      position.values.push_back(s * (kStep * i - 1));
      velocity.values.push_back(s);
      out.data.movement.push_back(m);
    }
  }
  out.data.channels = {time, position, velocity};
  out.data.movement_names = {"a", "b", "c", "d"};
  return out;
}

TEST(RecordingMovements, AMovementHasTurnedWhereAnotherTheOtherWayHasJustEnded) {
  PreparedRecording one = there_and_back({0, 1, 2, 3}, 0.03);
  PreparedRecording other = there_and_back({2, 0, 3, 1}, 0.03);
  sort_movements(other);
  EXPECT_EQ(other.data.movement, one.data.movement);
  EXPECT_EQ(other.data.channels[0].values, one.data.channels[0].values);
  settle_strokes(one, 0);
  settle_strokes(other, 0);
  const Channel& seen = one.data.at(loop::derived_channel_name(loop::kSeenDistance));
  EXPECT_LT(*std::ranges::min_element(seen.values), 0.02);
  for (const int m : {0, 1, 2, 3}) EXPECT_EQ(distances_in(one, m), distances_in(other, m)) << m;
  // What has happened in two seconds nobody has seen.
  PreparedRecording apart = there_and_back({0, 1, 2, 3}, 2);
  settle_strokes(apart, 0);
  EXPECT_THROW(distances_in(apart, 0), Error);
}

// A program that names a movement a moment late puts a stop and the next start the same way into
// it: what friction does at rest is in those rows, as it is at a stroke's ends.
TEST(RecordingMovements, AStopTooShortToEndAStrokeIsLeftOut) {
  PreparedRecording out;
  Channel time{"t", "s", Role::time, {}};
  Channel position{"q", "rad", Role::position, {}};
  Channel velocity{"v", "rad/s", Role::velocity, {}};
  double q = 0;
  for (int i = 0; i < 400; ++i) {
    const double to_stop = std::abs(i - 200) - 5;  // stands still for eleven rows
    const double v = std::clamp(0.05 * to_stop, 0.0, 1.0);
    time.values.push_back(kStep * i);
    position.values.push_back(q);
    velocity.values.push_back(v);
    q += kStep * v;
    out.data.movement.push_back(0);
  }
  out.data.movement_names.push_back("two strokes");
  out.data.channels = {time, position, velocity};
  settle_strokes(out, 0);
  const std::vector<double>& kept = out.data.at("v").values;
  EXPECT_EQ(kept.size(), 400U - 11);
  EXPECT_GE(*std::ranges::min_element(kept), 0.05);
}

// Six movements; the fourth alone has more than a touch of acceleration, in 40 of its rows.
TEST(RecordingMovements, AnAccelerationThatOneMovementAloneHoldsIsLeftOut) {
  PreparedRecording out;
  Channel torque{"tau", "N m", Role::motor_torque, {}};
  Channel acceleration{"derived_acceleration", "rad/s^2", Role::acceleration, {}};
  for (int m = 0; m < 6; ++m) {
    for (int i = 0; i < 200; ++i) {
      acceleration.values.push_back(m == 3 && i < 40 ? 8.0 : 0.1 * std::sin(0.1 * i));
      torque.values.push_back(1);
      out.data.movement.push_back(m);
    }
    out.data.movement_names.push_back("stroke");
  }
  out.data.channels = {torque, acceleration};
  PreparedRecording shared = out;
  for (double& a : shared.data.channels[1].values) a = std::abs(a) > 0.09 ? 8.0 : a;
  drop_lonely_acceleration(out);
  EXPECT_EQ(out.data.rows(), 1160U);
  for (const double a : out.data.find("derived_acceleration")->values) EXPECT_LT(std::abs(a), 0.2);
  EXPECT_THAT(out.notes, Contains(HasSubstr("40 of 1200 rows accelerate as no other")));
  drop_lonely_acceleration(shared);
  EXPECT_EQ(shared.data.rows(), 1200U);
}

}  // namespace
}  // namespace tribench
