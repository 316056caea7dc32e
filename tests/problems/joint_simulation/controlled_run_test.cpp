// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/controlled_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"

namespace tribench::simulation {
namespace {

ControlledRunPlan short_plan() {
  ControlledRunPlan plan;
  plan.seconds = 20;
  return plan;
}

TEST(ControlledRun, TheSameSeedGivesTheSameRun) {
  ControlledRunPlan plan = short_plan();
  plan.cause = "load";
  const ControlledRun one = run_under_control(plan, 3);
  const ControlledRun same = run_under_control(plan, 3);
  const ControlledRun other = run_under_control(plan, 4);
  EXPECT_EQ(one.data.find(Role::motor_torque)->values, same.data.find(Role::motor_torque)->values);
  EXPECT_NE(one.data.find(Role::motor_torque)->values, other.data.find(Role::motor_torque)->values);
}

TEST(ControlledRun, VelocityAndAccelerationAreThePositions) {
  const ControlledRun run = run_under_control(short_plan(), 1);
  const std::vector<double>& q = run.data.find(Role::position)->values;
  const std::vector<double>& v = run.data.find(Role::velocity)->values;
  const std::vector<double>& a = run.data.find(Role::acceleration)->values;
  const double dt = run.data.find(Role::time)->values[1];
  double top = 0;
  for (std::size_t i = 1; i + 1 < q.size(); ++i) {
    ASSERT_NEAR((q[i + 1] - q[i - 1]) / (2 * dt), v[i], 2e-3) << i;
    ASSERT_NEAR((v[i + 1] - v[i - 1]) / (2 * dt), a[i], 1.0) << i;
    top = std::max(top, std::abs(v[i]));
  }
  EXPECT_GT(top, 0.1);
}

TEST(ControlledRun, WhatIsPlantedHasTheSizeAskedFor) {
  ControlledRunPlan plan = short_plan();
  plan.cause = "viscous_power";
  plan.scale = 3;
  const ControlledRun run = run_under_control(plan, 5);
  double squares = 0;
  double rows = 0;
  for (std::size_t i = 0; i < run.move.size(); ++i) {
    if (run.move[i] < 0) {
      EXPECT_EQ(run.effects.at(0).values[i], 0);
      continue;
    }
    squares += run.effects.at(0).values[i] * run.effects.at(0).values[i];
    ++rows;
  }
  EXPECT_NEAR(std::sqrt(squares / rows), 3 * run.noise_sd, 1e-9);
  plan.cause = "magic";
  EXPECT_THROW(run_under_control(plan, 5), Error);
}

TEST(ControlledRun, TheCleanTableHasFrictionInMotionAlone) {
  const ControlledRun run = run_under_control(short_plan(), 2);
  const Dataset clean = run.clean();
  const std::vector<double>& v = clean.find(Role::velocity)->values;
  const std::vector<double>& friction = clean.find(Role::friction_torque)->values;
  ASSERT_GT(clean.rows(), 1000U);
  for (std::size_t i = 0; i < clean.rows(); ++i) {
    ASSERT_GE(std::abs(v[i]), 0.02);
    // Coulomb friction of 4 to 8 N m and viscous friction beside it, whatever the load.
    if (std::abs(v[i]) > 0.2) ASSERT_GT(friction[i] * v[i], 0) << i;
  }
  EXPECT_EQ(clean.movement_names.size(),
            1U + static_cast<std::size_t>(*std::ranges::max_element(clean.movement)));
}

}  // namespace
}  // namespace tribench::simulation
