// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribench::simulation {
namespace {

TEST(Motion, AStrokeSpeedsUpKeepsItsSpeedAndStops) {
  Movement movement(-1);
  movement.add_stroke(1, 0.5, 2);  // 0.25 s up, 3.75 s at 0.5 rad/s, 0.25 s down
  EXPECT_DOUBLE_EQ(movement.duration_s(), 4.25);
  EXPECT_DOUBLE_EQ(movement.at(0.1).velocity_rad_s, 0.2);
  EXPECT_DOUBLE_EQ(movement.at(2).velocity_rad_s, 0.5);
  EXPECT_DOUBLE_EQ(movement.at(2).acceleration_rad_s2, 0);
  EXPECT_NEAR(movement.at(4.25).position_rad, 1, 1e-12);
  EXPECT_NEAR(movement.at(4.25).velocity_rad_s, 0, 1e-12);
  // Too short a way for the speed: 0.02 rad at 2 rad/s^2 reaches 0.2 rad/s.
  movement.add_stroke(0.98, 0.5, 2);
  EXPECT_NEAR(movement.at(4.35).velocity_rad_s, -0.2, 1e-9);
  EXPECT_NEAR(movement.duration_s(), 4.45, 1e-12);
}

TEST(Motion, VelocityAndAccelerationAreDerivatives) {
  for (const Design design : kDesigns) {
    for (const Movement& movement : make_movements(design, RandomStream(3))) {
      const double h = 1e-5;
      for (double t = h; t + h < movement.duration_s(); t += movement.duration_s() / 17) {
        const MotionState before = movement.at(t - h);
        const MotionState now = movement.at(t);
        const MotionState after = movement.at(t + h);
        EXPECT_NEAR((after.position_rad - before.position_rad) / (2 * h), now.velocity_rad_s, 1e-4)
            << design_name(design);
        EXPECT_LE(std::abs(now.position_rad), 1.95);
      }
    }
  }
}

TEST(Motion, DesignsAreWhatTheirNamesSay) {
  EXPECT_EQ(make_movements(Design::few_long, RandomStream(1)).size(), 8U);
  EXPECT_GT(make_movements(Design::many_short, RandomStream(1)).size(), 200U);
  for (const Movement& movement : make_movements(Design::one_way, RandomStream(1))) {
    for (double t = 0; t < movement.duration_s(); t += 0.05) {
      EXPECT_GE(movement.at(t).velocity_rad_s, 0);
    }
  }
  double reversals = 0;
  for (const Movement& movement : make_movements(Design::few_long, RandomStream(1))) {
    EXPECT_GE(movement.duration_s(), 55);
    for (double t = 0.1; t < movement.duration_s(); t += 0.1) {
      reversals += movement.at(t).velocity_rad_s * movement.at(t - 0.1).velocity_rad_s < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(reversals, 50);
}

}  // namespace
}  // namespace tribench::simulation
