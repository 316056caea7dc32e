// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/diagnosis.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/campaign/rules.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "problems/joint_simulation/controlled_run.hpp"
#include "problems/joint_simulation/simulated_campaign.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/preparation/test_movements.hpp"
#include "problems/reading/csv.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"
#include "tests/support/paths.hpp"

namespace tribench::loop {
namespace {

TEST(Diagnosis, SaysNothingWhereNothingIsMissing) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Diagnosis diagnosis = diagnose_planted({}, seed);
    EXPECT_EQ(diagnosis.verdict, Verdict::none);
    EXPECT_TRUE(diagnosis.effects.empty());
    EXPECT_TRUE(diagnosis.events.empty());
  }
}

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
  const Diagnosis diagnosis = diagnose_most(observe(planted.data), options);
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
                      SimulatedCause{"friction_ripple", "output_ripple", mixed, 7},
                      SimulatedCause{"friction_ripple", "output_ripple", few_long, 8},
                      SimulatedCause{"gear_ripple_drifting", "gear_ripple", few_long, 7},
                      SimulatedCause{"presliding_dahl", "hysteresis", many_short, 7},
                      SimulatedCause{"spring", "spring", mixed, 7},
                      SimulatedCause{"spring", "spring", few_long, 8}));

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
    EXPECT_EQ(families(diagnose_most(data, {})), std::vector<std::string>{"hysteresis"}) << lambda;
  }
}

// Bristles let friction build up. What falls with the distance is something else, and lives there.
TEST(Diagnosis, FrictionThatFallsAfterAReversalIsNoPresliding) {
  const Observations data =
      campaign_with([](double v, double d) { return 2 * std::copysign(std::exp(-d / 0.01), v); });
  const Diagnosis diagnosis = diagnose_most(data, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"distance_since_reversal"}));
  EXPECT_THAT(families(diagnosis), ::testing::Not(::testing::Contains("hysteresis")));
}

// Sines cut out of motion, with bristles that were bent before each began, and friction that
// follows the velocity by 0.12 s late: `late` times as large.
Observations bristles_cut_out_of_motion(double late) {
  RandomStream random(5);
  std::string text = "movement,time_s,q,v,a,friction_torque_Nm\n";
  for (int m = 0; m < 45; ++m) {
    const double w = random.uniform(0.6, 1.8);
    const double size = random.uniform(0.3, 1.0);
    const double begin = random.uniform(0, 6);
    double bristles = 0;
    double follower = 0;
    for (int i = 0; i < 300; ++i) {
      const double angle = begin + 0.02 * w * i;
      const double v = size * w * std::cos(angle);
      const double s = v > 0 ? 1 : -1;
      bristles = i == 0 ? s : s + (bristles - s) * std::exp(-0.02 * std::abs(v) / 0.03);
      follower = i == 0 ? v : v + (follower - v) * std::exp(-0.02 / 0.12);
      const double y = 3 * s + 6 * v + 2 * (bristles - s) +
                       late * (std::tanh(follower / 0.1) - std::tanh(v / 0.1)) +
                       0.2 * random.normal();
      text += fmt::format("{},{},{},{},{},{}\n", m, 10 * m + 0.02 * i, size * std::sin(angle), v,
                          -size * w * w * std::sin(angle), y);
    }
  }
  return observe(parse_csv(text, "cut.csv").data);
}

// With distances that start at 0 in each of its movements this was told as presliding and a lag.
TEST(Diagnosis, PreslidingOfMovementsCutOutOfMotionIsNoLag) {
  EXPECT_EQ(families(diagnose_most(bristles_cut_out_of_motion(0), {})),
            std::vector<std::string>{"hysteresis"});
}

// What adds far less to presliding near the same reversals is its shape, whatever memory it has.
TEST(Diagnosis, ASmallLagBesidePreslidingIsItsShape) {
  const Diagnosis diagnosis = diagnose_most(bristles_cut_out_of_motion(0.4), {});
  ASSERT_EQ(families(diagnosis), std::vector<std::string>{"hysteresis"});
  EXPECT_TRUE(diagnosis.effects[0].another_shape);
  EXPECT_THAT(diagnosis.notes, ::testing::Contains(::testing::HasSubstr("'lag' only shapes")));
}

// The same curve up to its sign, at a third of the top speed: whether friction falls tells whose it
// is.
TEST(Diagnosis, AWideCurveIsStribeckWhereFrictionFallsAndNonlinearWhereItRises) {
  const auto with_curve = [](double size) {
    return campaign_with(
        [&](double v, double) { return std::copysign(size * std::exp(-std::abs(v) / 0.35), v); });
  };
  EXPECT_EQ(families(diagnose_most(with_curve(12), {})), std::vector<std::string>{"stribeck"});
  for (const double rising : {1.2, -1.2}) {
    EXPECT_EQ(families(diagnose_most(with_curve(rising), {})),
              std::vector<std::string>{"nonlinear_viscous"})
        << rising;
  }
}

// No two columns of one curve draw it; a third that is asked for makes it no less friction that
// changes with the speed.
TEST(Diagnosis, ACurveThatFallsAndRisesIsNamedThoughItAsksForAThirdColumn) {
  for (const double rise : {6, 20}) {
    const Diagnosis diagnosis =
        diagnose_most(campaign_with([&](double v, double) {
                        return std::copysign(3 * std::exp(-v * v / 0.04) + rise * v * v, v);
                      }),
                      {});
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << rise;
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"nonlinear_viscous"}) << rise;
  }
}

// Half of it is a curve in both directions, too small to be told first.
TEST(Diagnosis, AStribeckCurveInOneDirectionIsNamed) {
  const simulation::ControlledRun run =
      simulation::run_under_control({.cause = "stribeck_forwards", .scale = 1, .rate_hz = 250}, 4);
  const Diagnosis diagnosis = diagnose_most(observe(run.clean()).averaged(6000).data, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{"stribeck"});
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
  const Diagnosis with = diagnose_most(collided, options);
  options.without = {"bursts"};
  const Diagnosis without = diagnose_most(collided, options);
  EXPECT_EQ(with.events.size(), 3U);
  EXPECT_TRUE(without.events.empty());
  EXPECT_EQ(without.masked, std::vector<char>(collided.rows(), 0));
  EXPECT_GT(without.noise.within_sd, with.noise.within_sd);
  options.without = {"whitening"};
  EXPECT_FALSE(diagnose_most(collided, options).noise.whitened);
  EXPECT_TRUE(with.noise.whitened);
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

// What judges is not looked at: whatever the movements say that are held out, nothing changes.
TEST(Diagnosis, ChoosesNothingByAMovementThatIsHeldOut) {
  Observations data = observe(kuka::make_planted({.effects = {{"load_coulomb", 1.0}}}, 8).data);
  const std::vector<int> held_out = choose_test_movements(data, 0.2);
  const Diagnosis plain = diagnose(data, coulomb_viscous_base, {}, held_out);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (std::ranges::binary_search(held_out, data.movement[i])) data.target[i] *= 3;
  }
  const Diagnosis other = diagnose(data, coulomb_viscous_base, {}, held_out);
  EXPECT_EQ(families(plain), families(other));
  EXPECT_EQ(plain.after.coefficients, other.after.coefficients);
  EXPECT_EQ(plain.leftover.p, other.leftover.p);
}

TEST(Diagnosis, SaysNothingAboutNoiseFreeDataOfItsBase) {
  PlantedData planted = kuka::make_planted({}, 1);
  for (Channel& channel : planted.data.channels) {
    if (channel.role == Role::friction_torque) channel.values = planted.truth.base;
  }
  const Observations data = observe(planted.data);
  EXPECT_EQ(diagnose_most(data, options_of_planted()).verdict, Verdict::none);
}

// What is left of a fall with speed where nobody recorded it is a tail; fitted with a free scale it
// came to 77 N m at standstill, of 1.9.
TEST(Diagnosis, ClaimsNoFallWithSpeedBelowTheSlowestRow) {
  const kuka::PlantedCase planted{.effects = {{"stribeck", 2.0}}};
  for (const double slowest : {0.05, 0.1, 0.2, 0.6}) {
    ObservationOptions observing;
    observing.min_speed = slowest;
    const Observations data = observe(kuka::make_planted(planted, 1).data, observing);
    const Diagnosis diagnosis = diagnose_most(data, options_of_planted());
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
        const Diagnosis diagnosis = diagnose_most(data, {});
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

// A load that is off by more than half is not believed; what is missing then lives in the load, not
// in whatever other column has a "g" in its formula.
TEST(Diagnosis, AnUnphysicalEffectIsLeftOverInItsOwnInputs) {
  Observations data =
      observe(kuka::make_planted({.effects = {{"nonlinear_viscous", 2.0}}}, 4).data);
  const std::vector<double>& g = data.find("g")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] += 0.7 * g[i];
  DiagnosisOptions options = options_of_planted();
  options.physical_vetoes = true;
  options.families = {"nonlinear_viscous", "power_quadrant_gain"};
  const Diagnosis diagnosis = diagnose_most(data, options);
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
  const Diagnosis diagnosis = diagnose_most(data, options);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, (std::vector<std::string>{"velocity"}));
}

// Grids hand over whatever target they have: all residuals zero, or all of one size.
TEST(Diagnosis, SaysNothingAboutATargetOfNoughtOrOfOneSize) {
  Observations data = observe(kuka::make_planted({}, 1).data);
  for (const double size : {0.0, 1.0}) {
    for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] = i % 2 == 0 ? size : -size;
    const Diagnosis diagnosis = diagnose_most(data, options_of_planted());
    EXPECT_TRUE(diagnosis.effects.empty()) << size;
    EXPECT_TRUE(diagnosis.events.empty()) << size;
  }
}

// In a third of a turn twice a wave explains nearly what the wave does: taken first it left a
// payload beside it.
TEST(Diagnosis, HarmonicsOfAWaveAreToldInAThirdOfATurn) {
  for (const std::uint64_t seed : {8106U, 8186U}) {
    const simulation::ControlledRun run = simulation::run_under_control(
        {.cause = "output_ripple_harmonics", .scale = 1.5, .rate_hz = 250}, seed);
    const Observations data = observe(run.clean()).averaged(6000).data;
    EXPECT_EQ(families(diagnose_most(data, {})), std::vector<std::string>{"output_ripple"}) << seed;
  }
}

// Back and forth at constant speeds over less than a quarter of a turn, friction with five waves a
// turn and a gear's ripple. In the noise of a model that lacks both, six waves look as likely;
// taken first they left a payload beside them.
Observations short_strokes_with_ripples(std::uint64_t seed) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,friction_torque_Nm\n";
  for (int m = 0; m < 28; ++m) {
    const double top = random.uniform(0.05, 1) / (1 + 4 * static_cast<double>(random.below(2)));
    const double ramp = top / 3;  // s
    const double half = random.uniform(0.6, 1.3) / top + ramp;
    double q = -random.uniform(0.45, 0.75);
    for (int i = 0; i < 400; ++i) {
      const double t = std::fmod(0.03 * i, 2 * half);
      const double since = std::fmod(t, half);
      const double speed = std::min(top, 3 * std::min(since, half - since));
      const double v = t < half ? speed : -speed;
      q += 0.03 * v;
      const double s = t < half ? 1 : -1;
      const double y = 3.5 * s + 9.8 * v + 0.42 * std::cos(5 * q + 1) + 0.1 * std::cos(100 * q) +
                       0.08 * std::cos(200 * q + 1) + 0.145 * random.normal();
      text += fmt::format("{},{},{},{},{}\n", m, 20 * m + 0.03 * i, q, v, y);
    }
  }
  return observe(parse_csv(text, "strokes.csv").data);
}

TEST(Diagnosis, ChoosesTheWavesOfAnEffectAnewOnceOthersAreKnown) {
  DiagnosisOptions options;
  options.gear_ratios = {100};
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Diagnosis diagnosis = diagnose_most(short_strokes_with_ripples(seed), options);
    EXPECT_THAT(families(diagnosis),
                ::testing::UnorderedElementsAre("output_ripple", "gear_ripple"))
        << seed;
  }
}

// Neither a loss nor its sign: a declared load that is off by a third.
TEST(Diagnosis, ALoadThatIsDeclaredTooSmallOrTooLargeIsATorqueInProportionToIt) {
  for (const double off : {0.33, -0.25}) {
    Observations data = observe(kuka::make_planted({}, 5).data);
    const std::vector<double>& load = data.find("g")->values;
    for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] += off * load[i];
    const Diagnosis diagnosis = diagnose_most(data, options_of_planted());
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << off;
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"power_quadrant_gain"}) << off;
  }
}

}  // namespace
}  // namespace tribench::loop
