// SPDX-License-Identifier: MIT
//
// The simulated motion against motions that are known in closed form.
#include "algorithms/forward_dynamics/forward_simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/error.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "tests/algorithms/forward_dynamics/simulated_joint.hpp"

namespace tribench::forward {
namespace {

using testing::joint;
using testing::Movement;

TEST(ForwardSimulation, AConstantForceAgainstCoulombFrictionIsAParabola) {
  Movement movement(201, 0.01);
  std::ranges::fill(movement.drive, 5.0);
  const SimulatedMotion motion = simulate_motion(joint(2, "3*sgn_v"), nullptr, movement.rows(), {});
  ASSERT_EQ(motion.status, MotionStatus::complete);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    const double t = movement.time[i];
    EXPECT_NEAR(motion.velocity[i], t, 1e-12);
    EXPECT_NEAR(motion.position[i], t * t / 2, 1e-12);
  }
}

TEST(ForwardSimulation, AViscousJointRunsUpToItsFinalSpeed) {
  Movement movement(101, 0.02);
  std::ranges::fill(movement.drive, 5.0);
  SimulationOptions options;
  options.tolerance = 1e-10;
  const SimulatedMotion motion =
      simulate_motion(joint(2, "1*sgn_v + 4*v"), nullptr, movement.rows(), options);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    EXPECT_NEAR(motion.velocity[i], 1 - std::exp(-2 * movement.time[i]), 1e-8);
  }
}

// m a + k q + F sgn v = 0 from rest at q0: half periods of pi sqrt(m/k) between turning points that
// lie 2F/k closer each time, until |q| <= F/k, where it sticks.
TEST(ForwardSimulation, ASpringWithDryFrictionLosesFourForcesOverStiffnessAPeriod) {
  const double m = 0.5, k = 8, force = 0.7, q0 = 1.0;
  const double half_period = std::numbers::pi * std::sqrt(m / k);
  Movement movement(2001, 0.0025, q0);
  SimulationOptions options;
  options.tolerance = 1e-10;
  const SimulatedMotion motion =
      simulate_motion(joint(m, "0.7*sgn_v", "8*q"), nullptr, movement.rows(), options);
  ASSERT_EQ(motion.status, MotionStatus::complete);
  const double loss = 2 * force / k;
  double turning = q0;  // where the current half period began
  int half = 0;
  while (std::abs(turning) > force / k) {
    const double side = turning > 0 ? 1 : -1;
    const double centre = side * force / k;
    for (std::size_t i = 0; i < movement.time.size(); ++i) {
      const double t = movement.time[i] - half * half_period;
      if (t < 0 || t > half_period) continue;
      const double expected = centre + (turning - centre) * std::cos(t * std::sqrt(k / m));
      EXPECT_NEAR(motion.position[i], expected, 2e-7) << "half period " << half;
    }
    turning = -side * (std::abs(turning) - loss);
    ++half;
  }
  EXPECT_EQ(half, 6);
  EXPECT_NEAR(motion.position.back(), turning, 2e-7);
  EXPECT_EQ(motion.velocity.back(), 0);
  EXPECT_EQ(motion.counts.standstills, 6U);
}

TEST(ForwardSimulation, AJointSticksUnderGravityUpToBreakAwayAndNoFurther) {
  // 2 sin(0.5) = 0.9589 < 1: it stays, until the drive falls below 0.9589 - 1.
  Movement movement(1001, 0.001, 0.5);
  for (std::size_t i = 0; i < movement.time.size(); ++i)
    movement.drive[i] = -0.2 * movement.time[i];
  const SimulatedMotion motion =
      simulate_motion(joint(0.1, "1*sgn_v", "2*sin(q)"), nullptr, movement.rows(), {});
  const double breaks_away = (1 - 2 * std::sin(0.5)) / 0.2;
  ASSERT_GT(breaks_away, 0.2);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    if (movement.time[i] < breaks_away) {
      EXPECT_EQ(motion.velocity[i], 0);
      EXPECT_EQ(motion.position[i], 0.5);
    } else if (movement.time[i] > breaks_away + 0.002) {
      EXPECT_LT(motion.velocity[i], 0);
    }
  }
  // Just after break-away the torque grows by 0.2 a second: v = -0.2 t^2 / 2 / I.
  const std::size_t soon = static_cast<std::size_t>((breaks_away + 0.02) / 0.001);
  const double t = movement.time[soon] - breaks_away;
  EXPECT_NEAR(motion.velocity[soon], -t * t, 1e-3 * t * t);
}

// Stribeck friction and gravity under a controller, through many reversals: with a tenth of the
// tolerance, a smaller error; with half the step, an eighth of it (third order).
TEST(ForwardSimulation, TheErrorFallsWithTheToleranceAndWithTheStep) {
  Movement movement(601, 0.01, 0.3);
  for (double& torque : movement.drive) torque = 0;
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 3 * std::sin(2.5 * movement.time[i]);
  }
  const JointModel model = joint(0.2, "sgn_v*(0.3 + 0.2*exp(-(v/0.1)^2)) + 0.4*v", "1.5*sin(q)");
  const auto last = [&](double tolerance, double longest) {
    SimulationOptions options;
    options.tolerance = tolerance;
    options.longest_step_s = longest;
    const SimulatedMotion motion = simulate_motion(model, nullptr, movement.rows(), options);
    EXPECT_EQ(motion.status, MotionStatus::complete);
    return motion;
  };
  const SimulatedMotion truth = last(1e-13, 1e-3);
  const auto error = [&](const SimulatedMotion& motion) {
    double largest = 0;
    for (std::size_t i = 0; i < motion.position.size(); ++i) {
      largest = std::max(largest, std::abs(motion.position[i] - truth.position[i]));
    }
    return largest;
  };
  const double loose = error(last(1e-4, 1));
  const double middle = error(last(1e-6, 1));
  const double tight = error(last(1e-9, 1));
  EXPECT_LT(middle, loose);
  EXPECT_LT(tight, middle);
  EXPECT_LT(tight, 1e-6);
}

// A stretch without a standstill, steps of a fixed length: half the step, an eighth of the error.
TEST(ForwardSimulation, HalfTheStepLeavesAnEighthOfTheError) {
  Movement movement(2, 1.0, 0.2, 1.0);
  const JointModel model = joint(0.5, "sgn_v*(0.3 + 0.2*exp(-(v/2)^2)) + 0.4*v", "1.5*sin(q)");
  const auto end = [&](double step) {
    Movement one = movement;
    std::ranges::fill(one.drive, 3.0);
    SimulationOptions options;
    options.tolerance = step < 1e-3 ? 1e-12 : 1e-2;
    options.longest_step_s = step;
    return simulate_motion(model, nullptr, one.rows(), options).position.back();
  };
  const double truth = end(1e-4);
  const double whole = std::abs(end(0.1) - truth);
  const double half = std::abs(end(0.05) - truth);
  const double quarter = std::abs(end(0.025) - truth);
  EXPECT_LT(half, whole / 6);
  EXPECT_LT(quarter, half / 6);
  EXPECT_LT(quarter, 1e-5);
}

// A LuGre bristle (declared beside the formula) on a slide under a slow sine: it pre-slides by the
// force over the stiffness, breaks away at the Stribeck level and runs, against an independent
// integration in fixed steps of a microsecond.
TEST(ForwardSimulation, ABristlePreslidesAndBreaksAwayAsItsEquationSays) {
  const double m = 2, s0 = 1e4, s1 = 60, fv = 3, sliding = 2e-4, breakaway = 3e-4, vs = 0.02;
  Movement movement(401, 0.001);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 4 * std::sin(12 * movement.time[i]);
  }
  const SimulatedMotion motion =
      simulate_motion(joint(m,
                            "z = lugre(v, sliding=2e-4, breakaway=3e-4, stribeck_velocity=0.02); "
                            "1e4*z + 63*v"),
                      nullptr, movement.rows(), {});
  ASSERT_EQ(motion.status, MotionStatus::complete);
  double q = 0, v = 0, z = 0, largest = 0, top = 0;
  const double h = 1e-6;
  for (std::size_t i = 0; i + 1 < movement.time.size(); ++i) {
    for (int k = 0; k < 1000; ++k) {
      const double u = movement.drive[i] + (movement.drive[i + 1] - movement.drive[i]) * k / 1000;
      const double g = sliding + (breakaway - sliding) * std::exp(-(v / vs) * (v / vs));
      v += h * (u - s0 * z - (s1 + fv) * v) / m;
      z += h * (v - std::abs(v) * z / g);
      q += h * v;
    }
    largest = std::max(largest, std::abs(q - motion.position[i + 1]));
    top = std::max(top, std::abs(q));
  }
  EXPECT_GT(top, 2e-3);  // it did break away
  EXPECT_LT(largest, 3e-3 * top);
  const SimulatedMotion again =
      simulate_motion(joint(m,
                            "z = lugre(v, sliding=2e-4, breakaway=3e-4, stribeck_velocity=0.02); "
                            "1e4*z + 63*v"),
                      nullptr, movement.rows(), {0, false, 1e-7, 2.5e-4});
  double difference = 0;
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    difference = std::max(difference, std::abs(again.position[i] - motion.position[i]));
  }
  EXPECT_LT(difference, 3e-3 * top);  // a quarter of the step changes little
}

TEST(ForwardSimulation, AFormulaThatHoldsTheInertiaMovesAsTheInertiaDoes) {
  Movement movement(401, 0.005);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 20 * std::cos(3 * movement.time[i]);
  }
  const SimulatedMotion apart =
      simulate_motion(joint(1.7, "2*sgn_v + 3*v"), nullptr, movement.rows(), {});
  const SimulatedMotion together =
      simulate_motion(joint(0, "2*sgn_v + 1.7*a + 3*v"), nullptr, movement.rows(), {});
  const SimulatedMotion curved =  // not affine in a: the equation is solved step by step
      simulate_motion(joint(0, "2*sgn_v + 1.7*a*(1 + 0*a) + 3*v"), nullptr, movement.rows(), {});
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    EXPECT_NEAR(together.position[i], apart.position[i], 1e-10);
    EXPECT_NEAR(curved.position[i], apart.position[i], 1e-9);
  }
}

// Gravity known as a formula, recorded along the motion, or inside the formula of the whole torque.
TEST(ForwardSimulation, GravityIsAFormulaARecordedColumnOrPartOfTheWhole) {
  Movement movement(201, 0.005, 0.4);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 1 + 2 * std::sin(3 * movement.time[i]);
  }
  const SimulatedMotion known =
      simulate_motion(joint(0.3, "0.1*sgn_v + 0.2*v", "2*sin(q)"), nullptr, movement.rows(), {});
  JointModel whole = joint(0, "0.1*sgn_v + 0.2*v + 0.3*a + g", "2*sin(q)");
  whole.is_whole = true;
  const SimulatedMotion inside = simulate_motion(whole, nullptr, movement.rows(), {});
  NamedColumns columns;
  columns.columns = {{"load", Role::gravity_torque}};
  const JointModel recorded =
      joint(0.3, "0.1*sgn_v + 0.2*v", std::string(kRecordedGravity), columns);
  ASSERT_EQ(recorded.inputs.recorded.size(), 1U);
  movement.recorded.resize(1);
  for (const double q : known.position) movement.recorded[0].push_back(2 * std::sin(q));
  const SimulatedMotion along = simulate_motion(recorded, nullptr, movement.rows(), {});
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    EXPECT_NEAR(inside.position[i], known.position[i], 1e-9);
    EXPECT_NEAR(along.position[i], known.position[i], 1e-4);  // straight between the rows
  }
}

// A formula that jumps with the sign of the acceleration (pre-sliding told by v a): while the
// torque lies in the jump the speed is held.
TEST(ForwardSimulation, AJumpAtNoAccelerationHoldsTheSpeed) {
  Movement movement(301, 0.01, 0.0, 1.0);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    const double t = movement.time[i];
    movement.drive[i] = t < 1 ? 3.2 : t < 2 ? 5 : 3.2;
  }
  SimulationOptions options;
  options.hold = true;
  const SimulatedMotion motion =
      simulate_motion(joint(0, "3*sgn_v + 0.5*sgn(v*a) + 2*a"), nullptr, movement.rows(), options);
  ASSERT_EQ(motion.status, MotionStatus::complete);
  EXPECT_NEAR(motion.velocity[100], 1, 1e-6);
  EXPECT_NEAR(motion.velocity[200], 1.75, 1e-6);  // (5 - 3 - 0.5) / 2
  EXPECT_NEAR(motion.velocity[300], 1.75, 1e-6);
}

TEST(ForwardSimulation, AVoltageMovesAMotorToItsNoLoadSpeedAndAnOpenCircuitLetsItRun) {
  JointModel model = joint(0.01, "0*v");
  model.motor = Motor{0.4, 4};
  Movement movement(1001, 0.002);
  std::ranges::fill(movement.drive, 6.0);
  movement.connected.assign(movement.time.size(), 1.0);
  for (std::size_t i = 800; i < movement.time.size(); ++i) movement.connected[i] = 0;
  const SimulatedMotion motion = simulate_motion(model, nullptr, movement.rows(), {});
  const double rate = 0.4 * 0.4 / 4 / 0.01;
  EXPECT_NEAR(motion.velocity[100], 15 * (1 - std::exp(-rate * 0.2)), 1e-4);
  EXPECT_NEAR(motion.velocity[900], motion.velocity[800], 1e-12);  // no current, no brake
  model.motor->most_current = 0.5;  // of 1.5 A at a standstill: 0.2 N m
  EXPECT_NEAR(simulate_motion(model, nullptr, movement.rows(), {}).velocity[100], 0.2 / 0.01 * 0.2,
              1e-9);
}

TEST(ForwardSimulation, AControllerSeesTheSimulatedMotionAndItsPast) {
  NamedColumns columns;
  columns.columns = {{"reference", Role::none}, {"position", Role::position}};
  const Controller controller =
      parse_controller("40*(reference - q) - 3*(position - q_2)/0.002", "2", columns, "--control");
  Movement movement(2001, 0.001);
  movement.control = {std::vector<double>(movement.time.size(), 0.5)};
  const SimulatedMotion motion =
      simulate_motion(joint(0.05, "0.2*sgn_v"), &controller, movement.rows(), {});
  ASSERT_EQ(motion.status, MotionStatus::complete);
  for (std::size_t i = 2; i < 200; ++i) {
    const double output =
        40 * (0.5 - motion.position[i]) - 3 * (motion.position[i] - motion.position[i - 2]) / 0.002;
    EXPECT_NEAR(motion.drive[i], std::clamp(output, -2.0, 2.0), 1e-9);
  }
  EXPECT_EQ(motion.drive[0], 2);                              // at its limit
  EXPECT_NEAR(motion.position.back(), 0.5, 0.2 / 40 + 1e-9);  // within what Coulomb friction holds
  EXPECT_NEAR(motion.velocity.back(), 0, 1e-9);
}

TEST(ForwardSimulation, InputsThatRememberTheMotionAreThoseOfItsRows) {
  Movement movement(801, 0.005);
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    movement.drive[i] = 6 * std::sin(2 * movement.time[i]);
  }
  const SimulatedMotion motion =
      simulate_motion(joint(1, "0.5*sgn_v + 2*v_lag60 + 3*d"), nullptr, movement.rows(), {});
  ASSERT_EQ(motion.status, MotionStatus::complete);
  loop::TimeLag lag(0.060);
  loop::DistanceSinceReversal distance(loop::PathFrom::position);
  double worst = 0;
  double before = 0;
  for (std::size_t i = 0; i < movement.time.size(); ++i) {
    const double v = motion.velocity[i];
    const double late = lag.next(v, i == 0 ? 0 : 0.005);
    const double d = distance.next(v, motion.position[i], i == 0 ? 0 : 0.005);
    if (i > 0 && i + 1 < movement.time.size() && before * v > 0) {
      const double a = (motion.velocity[i + 1] - motion.velocity[i - 1]) / 0.01;
      const bool turns = motion.velocity[i + 1] * v <= 0 || motion.velocity[i - 1] * v <= 0;
      const double left = movement.drive[i] - a - (v > 0 ? 0.5 : -0.5) - 2 * late - 3 * d;
      if (!turns) worst = std::max(worst, std::abs(left));
    }
    before = v;
  }
  EXPECT_LT(worst, 0.02);  // of 6: what differences of 5 ms rows leave
}

TEST(ForwardSimulation, ErrorsAreOfTheRowsThatAreNoStarts) {
  Movement movement(101, 0.01, 1.0);  // measured: it stands at 1
  std::ranges::fill(movement.drive, 2.0);
  SimulationOptions options;
  options.horizon_s = 0.25;
  const SimulatedMotion motion =
      simulate_motion(joint(1, "0*v"), nullptr, movement.rows(), options);
  EXPECT_THAT(motion.starts, ::testing::ElementsAre(0U, 25U, 50U, 75U, 100U));
  const MotionErrors errors = motion_errors(movement.rows(), motion);
  EXPECT_EQ(errors.rows, 96U);
  EXPECT_NEAR(errors.largest_position, 0.24 * 0.24, 1e-9);
  double sum = 0;
  for (int i = 1; i <= 24; ++i) sum += 1e-4 * i * i;
  EXPECT_NEAR(errors.mean_position, sum / 24, 1e-9);
  EXPECT_NEAR(errors.mean_velocity, 0.25, 1e-9);
}

TEST(ForwardSimulation, AFormulaWithoutAValueEndsTheRunAndHasNoError) {
  Movement movement(101, 0.01, 0.0, 0.5);
  std::ranges::fill(movement.drive, -2.0);
  const SimulatedMotion motion =
      simulate_motion(joint(1, "log(q + 0.01)*0 + 0*v"), nullptr, movement.rows(), {});
  EXPECT_EQ(motion.status, MotionStatus::not_finite);
  EXPECT_TRUE(std::isnan(motion.position.back()));
  EXPECT_TRUE(std::isnan(motion_errors(movement.rows(), motion).mean_position));
}

// Friction that drives the joint off a standstill both ways: a formula that is none. Counted.
TEST(ForwardSimulation, FrictionThatPushesIsCountedAndDoesNotHang) {
  Movement movement(101, 0.01);
  std::ranges::fill(movement.drive, 0.5);
  const SimulatedMotion motion =
      simulate_motion(joint(1, "-1*sgn_v"), nullptr, movement.rows(), {});
  EXPECT_EQ(motion.status, MotionStatus::complete);
  EXPECT_GT(motion.counts.pushed, 0U);
  EXPECT_NEAR(motion.velocity.back(), 1.5, 1e-9);
}

TEST(ForwardSimulation, StretchesEndWhereRowsAreMissing) {
  const std::vector<double> time = {0, 1, 2, 3, 20, 21, 22, 50};
  const std::vector<RowStretch> stretches = stretches_without_gaps(time);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].end, 4U);
  EXPECT_EQ(stretches[1].begin, 4U);
  EXPECT_EQ(stretches[1].end, 7U);
}

}  // namespace
}  // namespace tribench::forward
