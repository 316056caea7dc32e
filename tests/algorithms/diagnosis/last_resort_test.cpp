// SPDX-License-Identifier: MIT
//
// Rare effects are looked for where the usual ones leave something over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "problems/joint_simulation/simulated_campaign.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

Observations friction_that_changes_with_the_place(
    double scale = 2, simulation::Design design = simulation::Design::mixed,
    std::uint64_t seed = 7) {
  return observe(simulation::simulate(
                     {"friction_ripple", scale, simulation::NoiseKind::gaussian, design}, seed)
                     .data);
}

TEST(LastResort, FrictionThatChangesWithThePlaceIsUnknownWithoutIt) {
  const Observations data = friction_that_changes_with_the_place();
  DiagnosisOptions options;
  const Diagnosis with = diagnose_most(data, options);
  EXPECT_EQ(with.verdict, Verdict::effects);
  EXPECT_EQ(families(with), std::vector<std::string>{"output_ripple"});
  EXPECT_THAT(with.effects[0].atom, ::testing::StartsWith("sgn_v*cos("));
  options.without = {"last_resort"};
  const Diagnosis without = diagnose_most(data, options);
  EXPECT_EQ(without.verdict, Verdict::unknown);
  EXPECT_THAT(without.leftover.inputs, ::testing::Contains("position"));
}

// A saw's teeth are no sine: this cause, but a curve that the library does not have.
TEST(LastResort, FrictionThatJumpsAtAPlaceIsAnotherShapeOfIt) {
  Observations data = observe(kuka::make_planted({}, 5).data);
  const std::vector<double>& q = data.find("q")->values;
  const std::vector<double>& sign = data.find("sgn_v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double teeth = 4 * q[i] / (2 * std::numbers::pi);
    data.target[i] += 2 * sign[i] * (teeth - std::floor(teeth));
  }
  const Diagnosis diagnosis = diagnose_most(data, options_of_planted());
  ASSERT_EQ(families(diagnosis), std::vector<std::string>{"output_ripple"});
  EXPECT_TRUE(diagnosis.effects[0].another_shape);
}

// The gear's ripple as a controlled joint shows it: beyond some speed its inertia takes it.
TEST(LastResort, ARippleThatFallsWithTheSpeedIsTheRipple) {
  Observations data = observe(kuka::make_planted({}, 5).data);
  const std::vector<double>& q = data.find("q")->values;
  const std::vector<double>& v = data.find("v")->values;
  const double turn = 200;
  const double knee = 0.4 * *std::ranges::max_element(v);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double x = v[i] / knee;
    data.target[i] += 3 * (std::cos(turn * q[i]) + x * std::sin(turn * q[i])) / (1 + x * x);
  }
  DiagnosisOptions options = options_of_planted();
  options.gear_ratios = {100};
  const Diagnosis with = diagnose_most(data, options);
  EXPECT_EQ(with.verdict, Verdict::effects);
  EXPECT_EQ(families(with), std::vector<std::string>{"gear_ripple"});
  options.without = {"last_resort"};
  EXPECT_EQ(diagnose_most(data, options).verdict, Verdict::unknown);
}

// Gravity is a function of the place, and may be what a smoother of it is made of.
TEST(LastResort, IsAskedWhereGravityStandsForThePlace) {
  for (const std::uint64_t seed : {39U, 136U}) {
    const Observations data =
        friction_that_changes_with_the_place(1, simulation::Design::few_long, seed);
    DiagnosisOptions options;
    EXPECT_EQ(families(diagnose_most(data, options)), std::vector<std::string>{"output_ripple"});
    options.without = {"last_resort"};
    EXPECT_EQ(diagnose_most(data, options).leftover.inputs,
              std::vector<std::string>{"gravity_torque"});
  }
}

// What the load does to the friction nobody can tell from it where nobody tells the load.
TEST(LastResort, CouldBeLoadFrictionWhereTheLoadIsNotKnown) {
  const auto could_be_load = [](const Observations& data) {
    const Diagnosis diagnosis = diagnose_most(data, {});
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"output_ripple"});
    if (diagnosis.effects.empty()) return false;
    return std::ranges::count(diagnosis.effects[0].aliases, "load-dependent friction",
                              &AliasFinding::family) > 0;
  };
  Observations data = friction_that_changes_with_the_place();
  EXPECT_FALSE(could_be_load(data));
  std::erase_if(data.signals,
                [](const Signal& one) { return one.name == "g" || one.name == "sgn_g"; });
  EXPECT_TRUE(could_be_load(data));
}

// A campaign whose usual effects explain all of it is not looked at again: friction under a load
// has twice the wave of the load, too.
TEST(LastResort, TakesNothingFromTheUsualEffects) {
  for (const char* usual : {"load_coulomb", "output_ripple", "power_quadrant_step"}) {
    const Observations data = observe(kuka::make_planted({.effects = {{usual, 1.0}}}, 3).data);
    DiagnosisOptions options = options_of_planted();
    const Diagnosis with = diagnose_most(data, options);
    options.without = {"last_resort"};
    const Diagnosis without = diagnose_most(data, options);
    EXPECT_EQ(families(with), std::vector<std::string>{usual});
    EXPECT_EQ(with.after.coefficients, without.after.coefficients);
    // No usual effect is harder to find for it.
    EXPECT_TRUE(std::ranges::equal(with.candidates, without.candidates, {},
                                   &CandidateFinding::adjusted_p, &CandidateFinding::adjusted_p));
  }
}

}  // namespace
}  // namespace tribench::loop
