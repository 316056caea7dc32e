// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/motion_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "tests/algorithms/forward_dynamics/simulated_joint.hpp"

namespace tribench::forward {
namespace {

using testing::joint;
using testing::Movement;

// The motion of a pendulum of known parameters under a torque, as it would be recorded.
Movement recorded(const JointModel& truth, double rate) {
  Movement movement(601, 0.005, 0.2);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 2.5 * std::sin(rate * movement.time[i]) + 0.6;
  }
  const SimulatedMotion motion = simulate_motion(truth, nullptr, movement.rows(), {});
  EXPECT_EQ(motion.status, MotionStatus::complete);
  movement.position = motion.position;
  movement.velocity = motion.velocity;
  return movement;
}

std::vector<double> acceleration_of(const Movement& movement) {
  std::vector<double> a(movement.time.size(), 0.0);
  for (std::size_t i = 1; i + 1 < a.size(); ++i) {
    a[i] = (movement.velocity[i + 1] - movement.velocity[i - 1]) / 0.01;
  }
  return a;
}

TEST(RigidBodyFit, FindsInertiaAndGravityFromTheEquationsRows) {
  const JointModel truth = joint(0.15, "0.3*sgn_v + 0.2*v", "1.1*sin(q) + 0.4*cos(q)");
  const Movement movement = recorded(truth, 4);
  const std::vector<MovementRows> rows = {movement.rows()};
  const std::vector<std::vector<double>> a = {acceleration_of(movement)};
  JointModel model = joint(0, "0.3*sgn_v + 0.2*v + 0*a");
  RigidBodyTerms terms;
  for (const char* text : {"sin(q)", "cos(q)"}) {
    terms.gravity.push_back(parse(text, std::vector<std::string>{"q"}));
  }
  const double left = fit_rigid_body(model, terms, rows, a, "DATA");
  EXPECT_NEAR(model.inertia, 0.15, 0.003);
  ASSERT_TRUE(model.gravity);
  EXPECT_NEAR(model.gravity->node(0).value, 1.1, 0.02);
  EXPECT_LT(left, 0.05);
}

TEST(RigidBodyFit, SaysWhereTheRowsDoNotDetermineIt) {
  Movement movement(50, 0.01, 0.0, 1.0);  // constant velocity: no acceleration
  for (std::size_t i = 0; i < 50; ++i) movement.position[i] = movement.time[i];
  const std::vector<MovementRows> rows = {movement.rows()};
  const std::vector<std::vector<double>> a = {std::vector<double>(50, 0.0)};
  JointModel model = joint(0, "1*v + 0*a");
  EXPECT_THROW(fit_rigid_body(model, {true, {}}, rows, a, "DATA"), Error);
}

TEST(MotionFit, FindsEveryParameterFromTheMotionAlone) {
  const JointModel truth = joint(0.15, "0.3*sgn_v + 0.2*v", "1.1*sin(q)");
  const Movement slow = recorded(truth, 4);
  const Movement fast = recorded(truth, 7);
  const std::vector<MovementRows> rows = {slow.rows(), fast.rows()};
  JointModel model = joint(0.2, "0.2*sgn_v + 0.3*v", "1*sin(q)");
  const MotionFit fit = fit_to_motion(model, nullptr, rows, {true, true, false, true}, {}, 40);
  EXPECT_EQ(fit.parameters, 4);
  EXPECT_LT(fit.rms_after, 1e-4 * fit.rms_before);
  EXPECT_NEAR(model.inertia, 0.15, 1e-4);
  EXPECT_NEAR(model.friction.node(0).value, 0.3, 1e-3);
}

TEST(MotionFit, NeverEndsWorseAndLeavesExponentsAlone) {
  const JointModel truth = joint(0.15, "0.3*sgn_v + 0.1*v*abs(v)");
  const Movement movement = recorded(truth, 5);
  const std::vector<MovementRows> rows = {movement.rows()};
  JointModel model = joint(0.15, "0.25*sgn_v + 0.05*sgn_v*v^2");
  const MotionFit fit = fit_to_motion(model, nullptr, rows, {false, false, false, true}, {}, 2);
  EXPECT_EQ(fit.parameters, 2);
  EXPECT_LE(fit.rms_after, fit.rms_before);
}

}  // namespace
}  // namespace tribench::forward
