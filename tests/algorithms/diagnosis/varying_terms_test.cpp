// SPDX-License-Identifier: MIT
//
// What differs from movement to movement and stands in no column.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "problems/joint_simulation/simulated_campaign.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

constexpr std::string_view kRandomSlopes = "random_slopes";

Observations simulated(const char* cause, double scale, std::uint64_t seed,
                       simulation::Design design = simulation::Design::mixed) {
  return observe(
      simulation::simulate({cause, scale, simulation::NoiseKind::gaussian, design}, seed).data);
}

Diagnosis without_the_rule(const Observations& data) {
  DiagnosisOptions options;
  options.without = {std::string(kRandomSlopes)};
  return diagnose_most(data, options);
}

TEST(VaryingTerms, FrictionThatIsAnotherInEveryMovementIsNotNothing) {
  const Observations data = simulated("friction_by_movement", 1, 21);
  const Diagnosis diagnosis = diagnose_most(data, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"movement"});
  EXPECT_TRUE(diagnosis.leftover.signals.empty());
  ASSERT_TRUE(diagnosis.leftover.varying);
  EXPECT_EQ(diagnosis.leftover.varying->term, "coulomb_friction");
  EXPECT_GT(diagnosis.leftover.varying->share, 0.2);
  EXPECT_EQ(diagnosis.leftover.varying->movements.size(), diagnosis.movements);
  EXPECT_EQ(without_the_rule(data).verdict, Verdict::none);
}

// The other half carries nothing: what all have of it together is the pooled model's.
TEST(VaryingTerms, ALoadThatHalfOfTheMovementsCarryIsToldByMovement) {
  Observations data = simulated("", 1, 22);
  const std::vector<double>& q = data.find("q")->values;
  const std::vector<double>& load = data.find("g")->values;
  const double largest =
      std::abs(*std::ranges::max_element(load, {}, [](double one) { return std::abs(one); }));
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (data.movement[i] % 2 == 0) data.target[i] += 0.2 * largest * std::sin(q[i] + 1);
  }
  const Diagnosis diagnosis = diagnose_most(data, {});
  ASSERT_EQ(diagnosis.verdict, Verdict::unknown);
  ASSERT_TRUE(diagnosis.leftover.varying);
  EXPECT_EQ(diagnosis.leftover.varying->term, "payload");
}

// Two odd movements of twelve are not enough to be sure, and too many to say that nothing is
// missing.
TEST(VaryingTerms, TooMuchToBePassedOverIsADoubt) {
  const Observations campaign = simulated("", 1, 41);
  std::vector<char> keep(campaign.rows());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = campaign.movement[i] < 12 ? 1 : 0;
  Observations data = campaign.select(keep);
  EXPECT_FALSE(diagnose_most(data, {}).leftover.varying);
  const std::vector<double>& q = data.find("q")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (data.movement[i] % 6 == 5) data.target[i] += 2 * std::sin(q[i]);
  }
  const Diagnosis diagnosis = diagnose_most(data, {});
  ASSERT_TRUE(diagnosis.leftover.is_in_doubt());
  EXPECT_EQ(diagnosis.leftover.varying->term, "payload");
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.verdict, Verdict::cannot_tell);
  ASSERT_FALSE(diagnosis.needed.empty());
  EXPECT_NE(diagnosis.needed[0].find("'payload'"), std::string::npos);
}

// Offsets are noise, but are told where they are most of it.
TEST(VaryingTerms, LargeOffsetsAreARemark) {
  Observations data = simulated("", 1, 23);
  const auto has_remark = [](const Diagnosis& diagnosis) {
    return std::ranges::any_of(diagnosis.notes, [](const std::string& note) {
      return note.find("offsets of the movements") != std::string::npos;
    });
  };
  EXPECT_FALSE(has_remark(diagnose_most(data, {})));
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += data.movement[i] % 3 == 0 ? 2 : 0;
  }
  EXPECT_TRUE(has_remark(diagnose_most(data, {})));
}

// A cause that a signal follows is told by that signal.
TEST(VaryingTerms, WhatFollowsASignalIsNoneOfThem) {
  for (const char* cause : {"temperature_lagged", "run_in_exponential", "load", "gravity_wrong"}) {
    for (const std::uint64_t seed : {31U, 32U}) {
      EXPECT_FALSE(diagnose_most(simulated(cause, 2, seed), {}).leftover.varying)
          << cause << ' ' << seed;
    }
  }
}

// Eight levels of friction are always like some slow signal: what shows within no movement may
// stand for them.
TEST(VaryingTerms, WhatFewMovementsShowOnlyBetweenThemIsNoEffect) {
  int stand_ins = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Observations data =
        simulated("friction_by_movement", 1, seed, simulation::Design::few_long);
    const Diagnosis diagnosis = diagnose_most(data, {});
    EXPECT_NE(diagnosis.verdict, Verdict::effects) << seed;
    for (const EffectFinding& effect : diagnosis.effects) {
      stand_ins += effect.stands_in ? 1 : 0;
      EXPECT_TRUE(effect.provisional || !effect.stands_in) << seed;
    }
  }
  EXPECT_GE(stand_ins, 1);
}

TEST(VaryingTerms, WhatFewMovementsShowWithinThemStays) {
  for (const char* cause :
       {"temperature_lagged", "run_in_exponential", "load", "stribeck_forwards"}) {
    const Diagnosis diagnosis =
        diagnose_most(simulated(cause, 2, 34, simulation::Design::few_long), {});
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << cause;
    EXPECT_FALSE(diagnosis.leftover.varying) << cause;
  }
}

// Beside friction that is another in every movement the run-in shows by whole movements alone.
TEST(VaryingTerms, WhatManyMovementsShowBetweenThemIsAnEffectBesideThem) {
  Observations data = simulated("run_in_exponential", 2, 33);
  const std::vector<double>& sign = data.find("sgn_v")->values;
  RandomStream random(5);
  std::vector<double> level(data.movement_names.size());
  for (double& one : level) one = 0.3 * random.normal();
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += level[static_cast<std::size_t>(data.movement[i])] * sign[i];
  }
  const Diagnosis diagnosis = diagnose_most(data, {});
  EXPECT_TRUE(diagnosis.leftover.varying);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "drift");
  EXPECT_FALSE(diagnosis.effects[0].provisional);
}

}  // namespace
}  // namespace tribench::loop
