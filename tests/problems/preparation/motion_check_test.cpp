// SPDX-License-Identifier: MIT
#include "problems/preparation/motion_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribench {
namespace {

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
