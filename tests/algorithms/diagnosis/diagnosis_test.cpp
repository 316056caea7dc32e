// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/diagnosis.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "algorithms/diagnosis/rules.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "problems/joint_simulation/simulated_campaign.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/reading/csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench::loop {
namespace {

// Signs of planted effects are random: the vetoes, which know which sign is physical, stay out.
DiagnosisOptions options_of_planted() {
  DiagnosisOptions options;
  options.physical_vetoes = false;
  options.gear_ratios = {160};
  return options;
}

Diagnosis diagnose_planted(const kuka::PlantedCase& planted, std::uint64_t seed) {
  const Observations data = observe(kuka::make_planted(planted, seed).data);
  return diagnose(data, coulomb_viscous_base, options_of_planted(), seed);
}

std::vector<std::string> families(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const EffectFinding& effect : diagnosis.effects) names.push_back(effect.family);
  return names;
}

TEST(Diagnosis, SaysNothingWhereNothingIsMissing) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Diagnosis diagnosis = diagnose_planted({}, seed);
    EXPECT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_TRUE(diagnosis.effects.empty());
    EXPECT_TRUE(diagnosis.events.empty());
  }
}

class PlantedEffect : public ::testing::TestWithParam<const char*> {};

TEST_P(PlantedEffect, IsNamedAndClosesTheLoopOnMovementsNobodyTouched) {
  const Diagnosis diagnosis = diagnose_planted({.effects = {{GetParam(), 1.0}}}, 2);
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{GetParam()});
  EXPECT_LT(diagnosis.error.mae_after, diagnosis.error.mae_before);
  EXPECT_GE(diagnosis.error.test_movements, 20U);
}

INSTANTIATE_TEST_SUITE_P(Families, PlantedEffect,
                         ::testing::Values("stribeck", "nonlinear_viscous", "load_coulomb",
                                           "load_viscous", "power_quadrant_gain",
                                           "power_quadrant_step", "payload", "output_ripple",
                                           "gear_ripple", "temperature", "drift", "hysteresis",
                                           "lag", "inertia", "coupling"));

TEST(Diagnosis, RefinesShapesOffItsGrid) {
  const Diagnosis diagnosis = diagnose_planted({.effects = {{"stribeck", 2.0}}}, 4);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  for (const ParameterFinding& p : diagnosis.effects[0].parameters) {
    if (p.name == "vs") EXPECT_NEAR(p.value, 0.06, 0.006);
    if (p.name == "delta") EXPECT_NEAR(p.value, 2, 0.5);
  }
}

// A large effect that differs between movements hides in the spread of their offsets; the wrong
// shape of its family would leave it there.
TEST(Diagnosis, ChoosesTheShapeThatLeavesTheLeastBetweenMovements) {
  const Diagnosis diagnosis = diagnose_planted({.effects = {{"nonlinear_viscous", 4.0}}}, 9);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "nonlinear_viscous");
  const auto power =
      std::ranges::find(diagnosis.effects[0].parameters, "n", &ParameterFinding::name);
  ASSERT_NE(power, diagnosis.effects[0].parameters.end());
  EXPECT_NEAR(power->value, 4, 0.4);
  EXPECT_LT(diagnosis.noise.between_sd, 0.08);  // planted: 0.045
}

// A joint simulated in time: its causes have a memory, no column of the library is theirs.
struct SimulatedCause {
  const char* cause;
  std::string_view family;
  simulation::Design design;
  std::uint64_t seed;
};

class Simulated : public ::testing::TestWithParam<SimulatedCause> {};

TEST_P(Simulated, IsNamedFirstAndNothingStaysUnknownBesideIt) {
  const auto& [cause, family, design, seed] = GetParam();
  const PlantedData planted = simulation::simulate(
      {.cause = cause, .scale = 1, .noise = simulation::NoiseKind::gaussian, .design = design},
      seed);
  DiagnosisOptions options;
  options.gear_ratios = {simulation::kGearRatio};
  const Diagnosis diagnosis = diagnose(observe(planted.data), coulomb_viscous_base, options, 1);
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].family, family);
  // What only corrects the shape of the first stands under its name.
  for (const EffectFinding& effect : diagnosis.effects) EXPECT_NE(effect.family, "stribeck");
}

using enum simulation::Design;
INSTANTIATE_TEST_SUITE_P(
    Causes, Simulated,
    ::testing::Values(SimulatedCause{"lag_of_velocity", "lag", mixed, 7},
                      SimulatedCause{"lag_of_velocity", "lag", many_short, 7},
                      SimulatedCause{"lag_of_friction", "lag", few_long, 7},
                      SimulatedCause{"output_ripple_harmonics", "output_ripple", one_way, 7},
                      SimulatedCause{"output_ripple_drifting", "output_ripple", many_short, 7},
                      SimulatedCause{"gear_ripple_drifting", "gear_ripple", few_long, 7},
                      SimulatedCause{"presliding_dahl", "hysteresis", many_short, 7}));

class OutsideTheLibrary
    : public ::testing::TestWithParam<std::pair<const char*, std::vector<std::string>>> {};

TEST_P(OutsideTheLibrary, IsUnknownAndLocated) {
  const auto& [effect, inputs] = GetParam();
  const Diagnosis diagnosis = diagnose_planted({.effects = {{effect, 1.0}}}, 3);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, inputs);
}

INSTANTIATE_TEST_SUITE_P(
    Leftovers, OutsideTheLibrary,
    ::testing::Values(std::pair{"velocity_bump", std::vector<std::string>{"velocity"}},
                      std::pair{"position_bump", std::vector<std::string>{"position"}},
                      std::pair{"temperature_position",
                                std::vector<std::string>{"position", "temperature"}}));

// Mean magnitude of the planted noise in the movements that a diagnosis has held out.
double noise_held_out(const std::vector<kuka::Plant>& effects, const Diagnosis& diagnosis,
                      std::uint64_t seed) {
  const PlantedData planted = kuka::make_planted({.effects = effects}, seed);
  double sum = 0;
  double rows = 0;
  for (std::size_t i = 0; i < planted.data.rows(); ++i) {
    const int movement = planted.data.movement[i];
    if (!std::ranges::binary_search(diagnosis.test_movements, movement)) continue;
    sum += std::abs(planted.truth.noise[i]);
    rows += 1;
  }
  return sum / rows;
}

// The other joint moves in fewer stretches than a test by flips needs; what its motion explains of
// whole movements speaks for itself.
TEST(Diagnosis, AnEffectInAFewStretchesIsRescuedByItsGain) {
  for (const std::uint64_t seed : {954432U, 954494U}) {
    const Diagnosis diagnosis = diagnose_planted({.effects = {{"coupling", 2.0}}}, seed);
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"coupling"});
    EXPECT_TRUE(diagnosis.effects.at(0).few_movements);
    EXPECT_EQ(std::ranges::count(diagnosis.untestable, "coupling", &UntestableFinding::family), 0);
    EXPECT_LT(diagnosis.error.mae_after,
              1.03 * noise_held_out({{"coupling", 2.0}}, diagnosis, seed));
    EXPECT_GT(diagnosis.error.mae_before, 1.3 * diagnosis.error.mae_after);
  }
}

// A narrow bump needs more harmonics than a family has: none of them is claimed.
TEST(Diagnosis, AFamilyThatAsksForEverMoreColumnsIsNotClaimed) {
  for (const std::uint64_t seed : {930621U, 930623U, 930625U}) {
    const Diagnosis diagnosis = diagnose_planted({.effects = {{"position_bump", 0.5}}}, seed);
    EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
    EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"position"}));
    EXPECT_TRUE(diagnosis.effects.empty());
  }
}

// The mean temperature is not 0, so a ripple whose size varies with temperature looks like one
// that does not, and something more: that one shares the leftover's input, and is not sure.
TEST(Diagnosis, ARippleThatVariesWithTemperatureIsNoSureRippleOfTheLibrary) {
  for (const double scale : {0.5, 2.0}) {
    const Diagnosis diagnosis =
        diagnose_planted({.effects = {{"temperature_position", scale}}}, 81017);
    EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
    EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"position", "temperature"}));
    for (const EffectFinding& effect : diagnosis.effects) EXPECT_TRUE(effect.provisional);
  }
}

// One sine of a UR10e's joint: presliding of less than a thousandth of the stroke.
TEST(Diagnosis, ReportsNoTwoColumnsThatOnlyCancelEachOther) {
  const auto folder = tribench::testing::shared_data();
  if (!folder) GTEST_SKIP() << tribench::testing::kNoSharedData;
  const Observations data =
      observe(read_csv(*folder / "ur10e-jointwise/joint6.csv").data).thinned(6000);
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {}, 1);
  const auto is_known = [&](const char* name) {
    return std::ranges::count(diagnosis.effects, name, &EffectFinding::family) > 0;
  };
  ASSERT_TRUE(is_known("hysteresis"));
  EXPECT_LT(diagnosis.error.mae_after, 0.85 * diagnosis.error.mae_before);
  for (const EffectFinding& effect : diagnosis.effects) {
    double largest = 0;
    for (const ParameterFinding& p : effect.parameters) {
      if (p.name == "presliding") largest = std::max(largest, std::abs(p.value));
    }
    // The Coulomb friction there is 0.25 A: nothing builds up to more than that.
    EXPECT_LT(largest, 0.3) << effect.family;
  }
  // Nothing is said twice.
  std::vector<std::string> notes = diagnosis.notes;
  std::ranges::sort(notes);
  EXPECT_TRUE(std::ranges::adjacent_find(notes) == notes.end());
}

// A campaign in which nothing is missing, and what `effect` makes of a row's velocity and of its
// distance since the reversal.
Observations campaign_with(const std::function<double(double v, double d)>& effect) {
  Observations data = observe(kuka::make_planted({}, 3).data);
  const std::vector<double>& v = data.find("v")->values;
  const std::vector<double>& d = data.find("d")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] += effect(v[i], d[i]);
  return data;
}

// Bristles give way within a tenth of a millirad to one: less than a thousandth of a stroke.
TEST(Diagnosis, PreslidingOfAThousandthOfTheStrokeIsNoLagAndNoFallWithSpeed) {
  for (const double lambda : {3e-4, 1e-3}) {
    const Observations data = campaign_with(
        [&](double v, double d) { return -2 * std::copysign(std::exp(-d / lambda), v); });
    EXPECT_EQ(families(diagnose(data, coulomb_viscous_base, {}, 1)),
              std::vector<std::string>{"hysteresis"})
        << lambda;
  }
}

// The same curve up to its sign, at a third of the top speed: whether friction falls tells whose it
// is.
TEST(Diagnosis, AWideCurveIsStribeckWhereFrictionFallsAndNonlinearWhereItRises) {
  const auto with_curve = [](double size) {
    return campaign_with(
        [&](double v, double) { return std::copysign(size * std::exp(-std::abs(v) / 0.35), v); });
  };
  EXPECT_EQ(families(diagnose(with_curve(12), coulomb_viscous_base, {}, 1)),
            std::vector<std::string>{"stribeck"});
  for (const double rising : {1.2, -1.2}) {
    EXPECT_EQ(families(diagnose(with_curve(rising), coulomb_viscous_base, {}, 1)),
              std::vector<std::string>{"nonlinear_viscous"})
        << rising;
  }
}

TEST(Diagnosis, NamesTwoEffects) {
  const Diagnosis diagnosis =
      diagnose_planted({.effects = {{"load_coulomb", 1.0}, {"hysteresis", 1.0}}}, 5);
  std::vector<std::string> names = families(diagnosis);
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"hysteresis", "load_coulomb"}));
}

TEST(Diagnosis, ListsWhatConstantVelocityCannotShow) {
  const Diagnosis diagnosis = diagnose_planted({.trajectories = 0}, 1);
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
  std::vector<std::string> untestable;
  for (const UntestableFinding& one : diagnosis.untestable) untestable.push_back(one.family);
  for (const char* family : {"asymmetry", "inertia", "lag", "coupling"}) {
    EXPECT_EQ(std::ranges::count(untestable, family), 1) << family;
  }
}

TEST(Diagnosis, ListsCollisionsAsEventsAndNotAsFriction) {
  const Diagnosis diagnosis = diagnose_planted({.collisions = 3, .collision_scale = 16}, 6);
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
  EXPECT_GE(diagnosis.events.size(), 2U);
}

// Every rule can be left out, and then it is: what it does is not done.
TEST(Diagnosis, DoesWithoutTheRulesThatItIsToldToLeaveOut) {
  const Observations collided =
      observe(kuka::make_planted({.collisions = 3, .collision_scale = 16}, 6).data);
  DiagnosisOptions options = options_of_planted();
  const Diagnosis with = diagnose(collided, coulomb_viscous_base, options, 1);
  options.without = {"bursts"};
  const Diagnosis without = diagnose(collided, coulomb_viscous_base, options, 1);
  EXPECT_EQ(with.events.size(), 3U);
  EXPECT_TRUE(without.events.empty());
  EXPECT_EQ(without.masked, std::vector<char>(collided.rows(), 0));
  EXPECT_GT(without.noise.within_sd, with.noise.within_sd);
  options.without = {"whitening"};
  EXPECT_EQ(diagnose(collided, coulomb_viscous_base, options, 1).noise.whitening, 0);
  EXPECT_GT(with.noise.whitening, 0);
}

TEST(Rules, AreKnownByTheirNamesAndOthersAreRefusedWithTheNearest) {
  for (const Rule& rule : rules()) EXPECT_EQ(find_rule(rule.name).purpose, rule.purpose);
  try {
    find_rule("whitning");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.mend().find("whitening"), std::string::npos) << error.mend();
  }
}

TEST(Diagnosis, IsTheSameForTheSameSeed) {
  const kuka::PlantedCase planted{.effects = {{"load_coulomb", 0.5}}};
  const Diagnosis one = diagnose_planted(planted, 8);
  const Diagnosis two = diagnose_planted(planted, 8);
  EXPECT_EQ(one.error.mae_after, two.error.mae_after);
  EXPECT_EQ(one.leftover.p, two.leftover.p);
  EXPECT_EQ(families(one), families(two));
  EXPECT_EQ(formula_of(one.after), formula_of(two.after));
}

TEST(Diagnosis, SaysNothingAboutNoiseFreeDataOfItsBase) {
  PlantedData planted = kuka::make_planted({}, 1);
  for (Channel& channel : planted.data.channels) {
    if (channel.role == Role::friction_torque) channel.values = planted.truth.base;
  }
  const Observations data = observe(planted.data);
  EXPECT_EQ(diagnose(data, coulomb_viscous_base, options_of_planted(), 1).verdict, Verdict::none);
}

// What is left of a fall with speed where nobody recorded it is a tail; fitted with a free scale it
// came to 77 N m at standstill, of 1.9.
TEST(Diagnosis, ClaimsNoFallWithSpeedBelowTheSlowestRow) {
  const kuka::PlantedCase planted{.effects = {{"stribeck", 2.0}}};
  for (const double slowest : {0.05, 0.1, 0.2, 0.6}) {
    ObservationOptions observing;
    observing.min_speed = slowest;
    const Observations data = observe(kuka::make_planted(planted, 1).data, observing);
    const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options_of_planted(), 1);
    for (const EffectFinding& effect : diagnosis.effects) {
      for (const ParameterFinding& p : effect.parameters) {
        if (p.name == "vs") EXPECT_GE(p.value, slowest);
        if (p.name == "excess") EXPECT_LT(std::abs(p.value), 4);
      }
    }
    if (slowest < 0.6) continue;
    EXPECT_EQ(std::ranges::count(diagnosis.untestable, "stribeck", &UntestableFinding::family), 1);
  }
}

// A recording of a few long movements, in some of which a channel says something and in the others
// nothing. `effect`: what is missing, whatever the channel does.
Observations partly_excited(int movements, int excited, const std::string& channel,
                            std::uint64_t seed) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,a," + channel + ",friction_torque_Nm\n";
  double noise = 0;
  for (int m = 0; m < movements; ++m) {
    const double slow = random.uniform(0.5, 1.0);
    const double fast = slow * random.uniform(1.7, 2.3);
    for (int i = 0; i < 700; ++i) {
      const double t = 0.01 * i;
      const double q = 0.5 * std::sin(slow * t) + 0.3 * std::sin(fast * t);
      const double v = 0.5 * slow * std::cos(slow * t) + 0.3 * fast * std::cos(fast * t);
      const double a =
          -0.5 * slow * slow * std::sin(slow * t) - 0.3 * fast * fast * std::sin(fast * t);
      const double x = m < excited ? 10 * std::cos(q + 0.3) : 0;
      noise = 0.6 * noise + 0.24 * random.normal();
      const double s = v > 0 ? 1 : -1;
      const double y =
          8 * s + 14 * v + 2 * s * std::exp(-std::abs(v) / 0.1) + 0.05 * s * std::abs(x) + noise;
      text += fmt::format("{},{},{},{},{},{},{}\n", m, 7 * m + t, q, v, a, x, y);
    }
  }
  return observe(parse_csv(text, "partly.csv").data);
}

// What one or two movements alone excite is known to no fold of the cross-validation but their own.
TEST(Diagnosis, LivesWithAChannelThatSaysSomethingInOneMovementOnly) {
  for (const char* channel : {"gravity_torque_Nm", "other_velocity_rad_s"}) {
    for (int movements = 2; movements <= 6; ++movements) {
      for (int excited = 1; excited <= std::min(2, movements - 1); ++excited) {
        const Observations data =
            partly_excited(movements, excited, channel, static_cast<std::uint64_t>(movements));
        const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {}, 1);
        EXPECT_NE(diagnosis.verdict, Verdict::none) << channel << movements;
        for (const EffectFinding& effect : diagnosis.effects) {
          EXPECT_TRUE(std::isfinite(effect.gain)) << effect.family;
          for (const AliasFinding& alias : effect.aliases) {
            EXPECT_TRUE(std::isfinite(alias.gain_difference)) << alias.family;
          }
        }
        for (const CandidateFinding& candidate : diagnosis.candidates) {
          EXPECT_TRUE(std::isnan(candidate.gain) || std::abs(candidate.gain) < 1e12)
              << candidate.family << candidate.gain;
        }
      }
    }
  }
}

// A gain of the load is not physical beyond a fifth; what is missing then lives in the load, not in
// whatever other column has a "g" in its formula.
TEST(Diagnosis, AnUnphysicalEffectIsLeftOverInItsOwnInputs) {
  Observations data =
      observe(kuka::make_planted({.effects = {{"nonlinear_viscous", 2.0}}}, 4).data);
  const std::vector<double>& g = data.find("g")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] += 0.5 * g[i];
  DiagnosisOptions options = options_of_planted();
  options.physical_vetoes = true;
  options.families = {"nonlinear_viscous", "power_quadrant_gain"};
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options, 4);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"gravity_torque"}));
}

// The other way round: "sgn_v" has a "g" too, and a recorded gravity torque is not to be blamed for
// what lives in the velocity alone.
TEST(Diagnosis, AnUnphysicalEffectOfVelocityIsNotBlamedOnTheGravityTorque) {
  Observations data = observe(kuka::make_planted({}, 4).data);
  const std::vector<double>& v = data.find("v")->values;
  const std::vector<double>& sign = data.find("sgn_v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] -= 3 * sign[i] * std::exp(-std::abs(v[i]) / 0.1);
  }
  DiagnosisOptions options = options_of_planted();
  options.physical_vetoes = true;
  options.families = {"stribeck"};
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options, 4);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"velocity"}));
}

// Grids hand over whatever target they have: all residuals zero, or all of one size.
TEST(Diagnosis, SaysNothingAboutATargetOfNoughtOrOfOneSize) {
  Observations data = observe(kuka::make_planted({}, 1).data);
  for (const double size : {0.0, 1.0}) {
    for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] = i % 2 == 0 ? size : -size;
    const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, options_of_planted(), 1);
    EXPECT_TRUE(diagnosis.effects.empty()) << size;
    EXPECT_TRUE(diagnosis.events.empty()) << size;
  }
}

}  // namespace
}  // namespace tribench::loop
