// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/shaking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/random.hpp"
#include "foundation/sign.hpp"

namespace tribench::loop {
namespace {

constexpr double kStep_s = 0.004;
constexpr double kSwing = 2 * std::numbers::pi * 6;  // rad/s

// A joint that goes there and back at one speed a movement, ramps of 0.4 s at its ends, and a
// torque of 6 Hz that nobody records and that shakes it. late: how much friction comes 60 ms late.
Observations shaken_joint(double torque, double late) {
  RandomStream random(11);
  Dataset data;
  data.channels = {{"time", "s", Role::time, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"tau_m", "N m", Role::motor_torque, {}}};
  double t = 0;
  for (int m = 0; m < 40; ++m) {
    data.movement_names.push_back(std::to_string(m));
    const double speed = random.uniform(0.05, 0.8);
    TimeLag lag(0.06);
    for (int i = 0; i < 1000; ++i, t += kStep_s) {
      const double s = std::fmod(i * kStep_s, 2.0);  // of a stroke of 2 s
      const double ramp = std::clamp(std::min(s, 2 - s) / 0.4, 0.0, 1.0);
      const double way = i * kStep_s < 2 ? 1 : -1;
      const double slope = s < 0.4 ? 1 / 0.4 : (s > 1.6 ? -1 / 0.4 : 0);
      const double angle = kSwing * t;
      // A stiff controller gives way a little: the acceleration is against the torque.
      const double v = way * speed * ramp + 0.004 * torque * std::cos(angle);
      const double a = way * speed * slope - 0.004 * torque * kSwing * std::sin(angle);
      const double before = lag.next(v, kStep_s);
      const double friction =
          8 * sign(v) + 14 * v + late * (std::tanh(before / 0.05) - std::tanh(v / 0.05));
      data.movement.push_back(m);
      for (std::size_t c = 0;
           const double value :
           {t, v, a, friction + 2 * a - torque * std::sin(angle) + 0.2 * random.normal()}) {
        data.channels[c++].values.push_back(value);
      }
    }
    t += 2;
  }
  return observe(data);
}

bool finds_lag(const Observations& data, bool with_rule) {
  DiagnosisOptions options;
  if (!with_rule) options.without = {"shaking"};
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options);
  return std::ranges::count(diagnosis.effects, "lag", &EffectFinding::family) > 0;
}

TEST(Shaking, WhatADisturbanceMovesIsNoLateFriction) {
  const Observations data = shaken_joint(1, 0);
  EXPECT_FALSE(finds_lag(data, true));
  EXPECT_TRUE(finds_lag(data, false));
}

// Late friction shows where the motion turns: without those rows no size of it is promised.
TEST(LateFriction, IsNotPromisedWhereTurnsAreLeftOut) {
  Observations data = shaken_joint(0, 0);
  const auto promises_lag = [&data] {
    bool any_other = false;
    bool lag = false;
    for (const CandidateFinding& one :
         diagnose(data, coulomb_viscous_base, DiagnosisOptions{}).candidates) {
      (one.family == "lag" ? lag : any_other) |= std::isfinite(one.detectable);
    }
    EXPECT_TRUE(any_other);
    return lag;
  };
  EXPECT_TRUE(promises_lag());
  data.turns_left_out = true;
  EXPECT_FALSE(promises_lag());
}

TEST(Shaking, FrictionThatIsLateInTheMotionItselfIsFound) {
  EXPECT_TRUE(finds_lag(shaken_joint(0, 2), true));
}

}  // namespace
}  // namespace tribench::loop
