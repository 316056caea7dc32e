// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/simulated_campaign.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "foundation/error.hpp"

namespace tribench::simulation {
namespace {

double root_mean_square(const std::vector<double>& x) {
  const double squares = std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(x.size()));
}

TEST(SimulatedCampaign, EveryCauseInEveryDesignIsFiniteAndOfItsSize) {
  for (const Cause& cause : causes()) {
    for (const Design design : kDesigns) {
      if (cause.needs_reversals && design == Design::one_way) continue;
      const PlantedData run =
          simulate({std::string(cause.name), 2, NoiseKind::gaussian, design}, 4);
      ASSERT_EQ(run.truth.effects.size(), 1U);
      const PlantedEffect& effect = run.truth.effects[0];
      EXPECT_NEAR(root_mean_square(effect.values) / run.truth.noise_sd, 2, 1e-9)
          << cause.name << " " << design_name(design);
      EXPECT_GT(run.data.rows(), 4000U);
      EXPECT_LT(run.data.rows(), 7500U);
      const std::vector<double>& target = run.data.find(Role::friction_torque)->values;
      const std::vector<double> clean = run.truth.noise_free();
      for (std::size_t i = 0; i < target.size(); ++i) {
        ASSERT_TRUE(std::isfinite(target[i])) << cause.name;
        ASSERT_NEAR(target[i], clean[i] + run.truth.noise[i], 1e-12);
      }
    }
  }
}

TEST(SimulatedCampaign, TheSeedDecidesAndWhatIsPlantedChangesNothingElse) {
  const PlantedData with = simulate({"load", 1, NoiseKind::skewed, Design::mixed}, 5);
  const PlantedData again = simulate({"load", 1, NoiseKind::skewed, Design::mixed}, 5);
  const PlantedData without = simulate({"", 0, NoiseKind::skewed, Design::mixed}, 5);
  const PlantedData other = simulate({"load", 1, NoiseKind::skewed, Design::mixed}, 6);
  EXPECT_EQ(with.data.find(Role::friction_torque)->values,
            again.data.find(Role::friction_torque)->values);
  EXPECT_EQ(with.truth.noise, without.truth.noise);
  EXPECT_EQ(with.data.find(Role::velocity)->values, without.data.find(Role::velocity)->values);
  EXPECT_NE(with.truth.noise, other.truth.noise);
}

TEST(SimulatedCampaign, AQuantisedSensorHasSteps) {
  const PlantedData run = simulate({"", 0, NoiseKind::quantised, Design::mixed}, 7);
  std::set<double> values;
  for (const double value : run.data.find(Role::friction_torque)->values) values.insert(value);
  EXPECT_LT(values.size(), 100U);
  const double step = *std::next(values.begin()) - *values.begin();
  EXPECT_NEAR(step / run.truth.noise_sd, 2.5, 0.01);
}

TEST(SimulatedCampaign, TimeAndTemperatureAreNotTheSame) {
  const PlantedData run = simulate({"", 0, NoiseKind::gaussian, Design::mixed}, 8);
  const std::vector<double>& celsius = run.data.find(Role::temperature)->values;
  EXPECT_EQ(celsius.front(), kCoolest_degc);
  EXPECT_GT(*std::ranges::max_element(celsius), kCoolest_degc + 5);
  // The pause half way cools it down.
  double largest_fall = 0;
  for (std::size_t i = 1; i < celsius.size(); ++i) {
    largest_fall = std::max(largest_fall, celsius[i - 1] - celsius[i]);
  }
  EXPECT_GT(largest_fall, 2);
}

Instant moving(double velocity) {
  Instant now;
  now.joint.velocity_rad_s = velocity;
  return now;
}

// Dahl's law integrated by hand: from saturation forwards, a path x backwards leaves
// z = -1 + 2 exp(-x/length); less Coulomb friction 2 exp(-x/length).
TEST(Causes, DahlsBristlesRelaxOverAPathWhateverTheSpeed) {
  const auto after = [](double speed, double path) {
    const Response friction = find_cause("presliding_dahl").start(RandomStream(9));
    const double dt = 1e-4;
    for (double x = 0; x < 2; x += 0.5 * dt) friction(moving(0.5), dt);
    double value = 0;
    const int steps = static_cast<int>(std::lround(path / (speed * dt)));
    for (int i = 0; i < steps; ++i) value = friction(moving(-speed), dt);
    return value;
  };
  const double length = -0.05 / std::log(after(0.1, 0.05) / 2);
  EXPECT_GT(length, 0.02);
  EXPECT_LT(length, 0.08);
  EXPECT_NEAR(after(0.1, 0.1), 2 * std::exp(-0.1 / length), 1e-9);
  EXPECT_NEAR(after(0.4, 0.1), after(0.1, 0.1), 1e-9);
}

// Four elements whose shares and limits only they know: what a small way from rest adds is what a
// small way back adds after a long stroke, since every element sticks again.
TEST(Causes, StiffnessIsThatOfEveryElementSticking) {
  const auto response = [] { return find_cause("presliding_gms").start(RandomStream(9)); };
  const Response friction = response();
  for (int i = 0; i < 1000; ++i) friction(moving(0.5), 1e-3);
  const double bent = friction(moving(-1e-6), 1);
  const double slope = (bent - friction(moving(-1e-6), 1)) / 1e-6;
  EXPECT_NEAR(relaxed_stiffness(response()), slope, 1e-3 * slope);
  EXPECT_GT(slope, 5);
}

// A step of the velocity: friction follows with one time constant, whatever the steps.
TEST(Causes, FrictionLagsItsVelocityByOneTimeConstant) {
  const auto after = [](double seconds, double dt) {
    const Response friction = find_cause("lag_of_friction").start(RandomStream(10));
    friction(moving(0.0), dt);
    double value = 0;
    for (int i = 0; i < std::lround(seconds / dt); ++i) value = friction(moving(0.3), dt);
    return value;
  };
  const double start = after(0.002, 0.002) * after(0.002, 0.002) / after(0.004, 0.002);
  EXPECT_LT(start, 0);
  const double constant = -0.02 / std::log(after(0.02, 0.002) / start);
  EXPECT_GT(constant, 0.03);
  EXPECT_LT(constant, 0.1);
  EXPECT_NEAR(after(0.04, 0.002), start * std::exp(-0.04 / constant), 1e-9);
  EXPECT_NEAR(after(0.04, 0.004), after(0.04, 0.002), 1e-9);
}

TEST(Causes, StribeckForwardsIsNothingBackwards) {
  const Response friction = find_cause("stribeck_forwards").start(RandomStream(1));
  EXPECT_GT(friction(moving(0.02), 0.01), 0.5);
  EXPECT_EQ(friction(moving(-0.02), 0.01), 0);
}

TEST(Causes, AnUnknownOneIsAnsweredWithTheNearest) {
  try {
    find_cause("presliding_dal");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.mend(), "did you mean presliding_dahl?");
  }
}

}  // namespace
}  // namespace tribench::simulation
