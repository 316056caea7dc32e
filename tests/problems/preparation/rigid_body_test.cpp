// SPDX-License-Identifier: MIT
#include "problems/preparation/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.hpp"

namespace tribench {
namespace {

// A joint that goes from 0.2 rad to 1.4 rad, and back where `back` is set, under 15 sin q.
Dataset lifted(bool back) {
  Dataset data;
  data.movement_names = {"move"};
  data.channels = {{"q", "rad", Role::position, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"tau", "N m", Role::motor_torque, {}}};
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.001 * i;
    const double phase = back ? 2 * t : 0.75 * t;
    const double q = 0.8 - 0.6 * std::cos(phase);
    const double v = 0.6 * (back ? 2 : 0.75) * std::sin(phase);
    const double sign = v > 0 ? 1 : v < 0 ? -1 : 0;
    const double row[] = {q, v, 4 * sign + 6 * v + 15 * std::sin(q) + 0.1 * std::sin(1e3 * t)};
    for (std::size_t k = 0; k < 3; ++k) data.channels[k].values.push_back(row[k]);
    data.movement.push_back(0);
  }
  return data;
}

TEST(RigidBody, GravityIsFoundWhereTheJointGoesBothWays) {
  const auto body = fit_rigid_body(lifted(true));
  ASSERT_TRUE(body);
  EXPECT_NEAR(body->sine, 15, 1);
  EXPECT_NEAR(body->cosine, 0, 1);
}

// One way, under a load of one sign, friction that grows with the load is gravity itself.
TEST(RigidBody, OneWayAloneGivesNoAbsurdGravity) {
  const auto body = fit_rigid_body(lifted(false));
  if (body) {
    EXPECT_LT(std::abs(body->sine) + std::abs(body->cosine), 100);
  }
}

// An inertia of 2 under jerks that a smoother took a third off as much as off half its bandwidth.
TEST(RigidBody, TheTorqueTellsWhatASmootherTookOffTheAcceleration) {
  Dataset data = lifted(true);
  Channel acceleration{"a", "rad/s^2", Role::acceleration, {}};
  std::vector<double> change;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double t = 0.001 * static_cast<double>(i);
    const double a = 0.6 * 4 * std::cos(2 * t);
    change.push_back(0.5 * std::sin(30 * t));
    acceleration.values.push_back(a);
    data.channels[2].values[i] += 2 * (a + change.back() / 3);
  }
  data.channels.push_back(acceleration);
  const std::optional<Blunting> blunting = acceleration_blunting(data, change);
  ASSERT_TRUE(blunting);
  EXPECT_NEAR(blunting->share, 1.0 / 3, 0.02);
  EXPECT_LT(blunting->error, 0.05);
  EXPECT_FALSE(acceleration_blunting(lifted(true), change));  // no acceleration
}

// Noise of 0.1 behind an inertia of 2 hides changes of 0.05.
TEST(RigidBody, WhatChangeOfTheAccelerationTheTorqueWouldShow) {
  Dataset data = lifted(true);
  RandomStream random(5);
  Channel acceleration{"a", "rad/s^2", Role::acceleration, {}};
  for (std::size_t i = 0; i < data.rows(); ++i) {
    acceleration.values.push_back(0.6 * 4 * std::cos(0.002 * static_cast<double>(i)));
    data.channels[2].values[i] += 2 * acceleration.values.back() + 0.1 * random.normal();
  }
  EXPECT_FALSE(visible_acceleration(data));
  data.channels.push_back(acceleration);
  // Here sin 2t is the speed and cos 2t the place too: without gravity the inertia is plain.
  data.channels[0].unit = "m";
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.channels[2].values[i] -= 15 * std::sin(data.channels[0].values[i]);
  }
  const std::optional<double> visible = visible_acceleration(data);
  ASSERT_TRUE(visible);
  EXPECT_NEAR(*visible, 0.1 / 2, 0.02);
}

// Twenty minutes at 100 Hz of a joint that never rests: in means of 20 rows the noise is 0.1 /
// sqrt(20), whatever the motion does to the torque from one mean to the next.
TEST(RigidBody, TheMotionIsNoNoiseOfMeans) {
  Dataset data;
  data.movement_names = {"cycles"};
  data.channels = {{"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"tau", "N m", Role::motor_torque, {}}};
  RandomStream random(7);
  for (int i = 0; i < 120'000; ++i) {
    const double t = 0.01 * i;
    const double v = std::sin(5 * t) + 0.6 * std::sin(11.3 * t);
    const double a = 5 * std::cos(5 * t) + 0.6 * 11.3 * std::cos(11.3 * t);
    const double torque = (v > 0 ? 4 : -4) + 6 * v + 2 * a + 0.1 * random.normal();
    for (std::size_t k = 0; k < 3; ++k) {
      data.channels[k].values.push_back(k == 0 ? v : k == 1 ? a : torque);
    }
    data.movement.push_back(0);
  }
  const std::optional<double> visible = visible_acceleration(data);
  ASSERT_TRUE(visible);
  EXPECT_NEAR(*visible, 0.1 / std::sqrt(20.0) / 2, 0.004);
}

// Friction of 4 that turns 0.1 s after the motion goes against the acceleration, by more than an
// inertia of 0.3 goes with it.
TEST(RigidBody, LateFrictionHidesNoInertia) {
  Dataset data = lifted(true);
  RandomStream random(6);
  data.channels[0].unit = "m";
  Channel time{"t", "s", Role::time, {}};
  Channel acceleration{"a", "m/s^2", Role::acceleration, {}};
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double t = 0.001 * static_cast<double>(i);
    time.values.push_back(t);
    acceleration.values.push_back(0.6 * 4 * std::cos(2 * t));
    const double late = std::sin(2 * (t - 0.1)) > 0 ? 4 : -4;
    data.channels[2].values[i] = late + 0.3 * acceleration.values.back() + 0.1 * random.normal();
  }
  data.channels.push_back(time);
  data.channels.push_back(acceleration);
  const std::optional<double> visible = visible_acceleration(data);
  ASSERT_TRUE(visible);
  EXPECT_NEAR(*visible, 0.1 / 0.3, 0.07);
}

}  // namespace
}  // namespace tribench
