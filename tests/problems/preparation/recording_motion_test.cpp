// SPDX-License-Identifier: MIT
//
// Whose velocity is believed: the recording's own or its position's. Joints that are taken through
// ramps and holds, noise-free but for the torque, told in several ways.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {
namespace {

// At instants `step` apart: the velocity is straight from one to the next, so that the position is
// exact.
struct RampedRide {
  double step = 0;
  std::vector<double> position;
  std::vector<double> velocity;
};

struct Speeds {
  double first = 0.027;
  double between = 0.079;
  int count = 12;
  double acceleration = 4.5;
};

RampedRide ramped_ride(double step, double seconds, const Speeds& speeds = {}) {
  constexpr double kHold_s = 1.2;
  RampedRide out{step, {0.3}, {0}};
  for (int n = 0; step * static_cast<double>(out.position.size()) < seconds; ++n) {
    const double sign = n % 2 == 0 ? 1 : -1;
    const double speed = speeds.first + speeds.between * ((n / 2) % speeds.count);
    const double whole = 2 * speed / speeds.acceleration + kHold_s;
    for (double t = step; t < whole; t += step) {
      const double ramp = std::min(t, whole - t) * speeds.acceleration;
      const double v = sign * std::clamp(ramp, 0.0, speed);
      out.position.push_back(out.position.back() + 0.5 * step * (v + out.velocity.back()));
      out.velocity.push_back(v);
    }
  }
  return out;
}

using PerRow = std::function<double(std::size_t row)>;

PreparedRecording recording_of(const RampedRide& ride, const PerRow& position,
                               const PerRow& velocity, std::size_t every = 1) {
  std::string text =
      fmt::format("time_s,position_rad,{}friction_torque_Nm\n", velocity ? "velocity_rad_s," : "");
  RandomStream noise(key_of("ride"));
  for (std::size_t i = 1; i + 1 < ride.position.size(); i += every) {
    const double v = ride.velocity[i];
    const double sign = v > 0 ? 1 : v < 0 ? -1 : 0;
    text += fmt::format("{:.4f},{:.9f},", ride.step * static_cast<double>(i), position(i));
    if (velocity) text += fmt::format("{:.9f},", velocity(i));
    text += fmt::format("{:.6f}\n", 20 * sign + 30 * v + noise.normal());
  }
  return prepare(parse_csv(text, "log.csv", {}), {}, Gravity::automatic);
}

// Speeds that were commanded in even steps are told exactly: their steps are no rounding.
TEST(RecordedMotion, SpeedsInEvenStepsAreBelievedWhereTheTorqueGoesWithThem) {
  const RampedRide one = ramped_ride(0.05, 200, {0.2, 0.2, 5, 4});
  const auto position = [&](std::size_t i) { return one.position[i]; };
  EXPECT_FALSE(
      recording_of(one, position, [&](std::size_t i) { return one.velocity[i]; }).derived_velocity);
  // Rounded to a few steps of its own it is not.
  EXPECT_TRUE(recording_of(one, position, [&](std::size_t i) {
                return 0.3 * std::round(one.velocity[i] / 0.3);
              }).derived_velocity);
}

// The way from row to row over the time is the velocity half a row ago: with it viscous friction
// has a part that goes with the acceleration, as an inertia has.
TEST(RecordedMotion, ADifferenceOfPositionsIsHalfARowLate) {
  const RampedRide one = ramped_ride(0.02, 120);
  const double count = 2 * std::numbers::pi / (1 << 18);
  const auto position = [&](std::size_t i) { return count * std::round(one.position[i] / count); };
  const auto difference = [&](std::size_t i) { return (position(i) - position(i - 1)) / one.step; };
  EXPECT_TRUE(recording_of(one, position, difference).derived_velocity);
  // Of every second row it is late by a quarter of a row.
  const RampedRide fast = ramped_ride(0.01, 240);
  const auto place = [&](std::size_t i) { return count * std::round(fast.position[i] / count); };
  const auto quarter = [&](std::size_t i) { return (place(i) - place(i - 1)) / fast.step; };
  EXPECT_TRUE(recording_of(fast, place, quarter, 2).derived_velocity);
}

// A simulator of semi-implicit steps tells the same columns; there the position is half a row late.
TEST(RecordedMotion, ASimulatorsVelocityIsItsTorques) {
  const RampedRide one = ramped_ride(0.02, 120);
  std::vector<double> stepped = {0};
  for (std::size_t i = 1; i < one.velocity.size(); ++i) {
    stepped.push_back(stepped.back() + one.step * one.velocity[i]);
  }
  const PreparedRecording recording = recording_of(
      one, [&](std::size_t i) { return stepped[i]; },
      [&](std::size_t i) { return one.velocity[i]; });
  EXPECT_FALSE(recording.derived_velocity);
}

// 20 rows a second do not show ramps of four rows: what a derived velocity lacks there would be
// taken for friction that depends on acceleration.
TEST(RecordedMotion, WhatADerivedVelocityLacksIsLeftOut) {
  const RampedRide one = ramped_ride(0.05, 200);
  const PreparedRecording recording = recording_of(
      one, [&](std::size_t i) { return 1e-4 * std::round(one.position[i] / 1e-4); }, {});
  EXPECT_TRUE(recording.derived_velocity);
  EXPECT_GT(recording.unresolved, 0U);
  const std::vector<double>& v = recording.data.find(Role::velocity)->values;
  const std::vector<double>& time = recording.data.find(Role::time)->values;
  double squares = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double e = v[i] - one.velocity[static_cast<std::size_t>(std::lround(time[i] / one.step))];
    squares += e * e;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(v.size())), 0.01);
}

}  // namespace
}  // namespace tribench
