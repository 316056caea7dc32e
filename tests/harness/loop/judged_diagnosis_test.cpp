// SPDX-License-Identifier: MIT
#include "harness/loop/judged_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "problems/joint_simulation/simulated_campaign.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"
#include "reports/record/loop_record.hpp"
#include "tests/harness/loop/judged_planted.hpp"
#include "tests/support/movements_with_offsets.hpp"
#include "tests/support/paths.hpp"

namespace tribench::loop {
namespace {

class PlantedEffect : public ::testing::TestWithParam<const char*> {};

TEST_P(PlantedEffect, IsNamedAndClosesTheLoopOnMovementsNobodyTouched) {
  const JudgedDiagnosis diagnosis = judge_planted({.effects = {{GetParam(), 1.0}}}, 2);
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

// Bristles that short strokes do not bend all the way: as a state they have the right stiffness,
// and leave less on movements nobody touched than the distance since the reversal does.
TEST(JudgedDiagnosis, FoundPreslidingHasAStiffnessAndIsWorthMoreAsAState) {
  const PlantedData run = simulation::simulate(
      {"presliding_dahl", 2, simulation::NoiseKind::gaussian, simulation::Design::mixed}, 230219);
  const JudgedDiagnosis diagnosis =
      diagnose_and_judge(observe(run.data), coulomb_viscous_base, {.gear_ratios = {100}});
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{"hysteresis"});
  ASSERT_TRUE(diagnosis.bristles);
  const double truth = run.truth.effects[0].stiffness;
  EXPECT_NEAR(diagnosis.bristles->stiffness, truth, 0.1 * truth);
  EXPECT_LT(diagnosis.bristles->low, truth);
  EXPECT_GT(diagnosis.bristles->high, truth);
  EXPECT_LT(diagnosis.error.mae_state, 0.95 * diagnosis.error.mae_after);
}

// Few movements, left out in turn: a search without some of them may name what all of them do not.
TEST(JudgedDiagnosis, WhereNothingIsNamedNothingIsBetter) {
  std::size_t unnamed = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    PlantedData planted = kuka::make_planted({.effects = {{"stribeck", 0.6}}}, seed);
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < planted.data.rows(); ++i) {
      if (planted.data.movement[i] < 14) rows.push_back(i);
    }
    DiagnosisOptions options;
    options.physical_vetoes = false;
    const JudgedDiagnosis diagnosis =
        diagnose_and_judge(observe(select_rows({planted.data, {}}, rows).data),
                           coulomb_viscous_base, options, JudgingOptions{});
    if (!diagnosis.effects.empty()) continue;
    ++unnamed;
    EXPECT_EQ(diagnosis.error.mae_before, diagnosis.error.mae_after) << seed;
  }
  EXPECT_GE(unnamed, 2U);
}

// Mean magnitude of the planted noise in the movements that a diagnosis has held out.
double noise_held_out(const std::vector<kuka::Plant>& effects, const Diagnosis& diagnosis,
                      std::uint64_t seed) {
  const PlantedData planted = kuka::make_planted({.effects = effects}, seed);
  double sum = 0;
  double rows = 0;
  for (std::size_t i = 0; i < planted.data.rows(); ++i) {
    const int movement = planted.data.movement[i];
    if (!std::ranges::binary_search(diagnosis.held_out, movement)) continue;
    sum += std::abs(planted.truth.noise[i]);
    rows += 1;
  }
  return sum / rows;
}

// The other joint moves in fewer stretches than a test by flips needs; what its motion explains of
// whole movements speaks for itself.
TEST(JudgedDiagnosis, AnEffectInAFewStretchesIsRescuedByItsGain) {
  for (const std::uint64_t seed : {954432U, 954494U}) {
    const JudgedDiagnosis diagnosis = judge_planted({.effects = {{"coupling", 2.0}}}, seed);
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{"coupling"});
    EXPECT_TRUE(diagnosis.effects.at(0).few_movements);
    EXPECT_EQ(std::ranges::count(diagnosis.untestable, "coupling", &UntestableFinding::family), 0);
    EXPECT_LT(diagnosis.error.mae_after,
              1.03 * noise_held_out({{"coupling", 2.0}}, diagnosis, seed));
    EXPECT_GT(diagnosis.error.mae_before, 1.3 * diagnosis.error.mae_after);
  }
}

// One sine of a UR10e's joint with its turns: what shows there is late, or presliding of less than
// a thousandth of the stroke.
TEST(JudgedDiagnosis, ReportsNoTwoColumnsThatOnlyCancelEachOther) {
  const auto folder = tribench::testing::shared_data();
  if (!folder) GTEST_SKIP() << tribench::testing::kNoSharedData;
  const Observations data =
      observe(read_csv(*folder / "ur10e-jointwise/joint6.csv").data).thinned(6000);
  const JudgedDiagnosis diagnosis = diagnose_and_judge(data, coulomb_viscous_base, {});
  const auto is_known = [&](const char* name) {
    return std::ranges::count(diagnosis.effects, name, &EffectFinding::family) > 0;
  };
  ASSERT_TRUE(is_known("hysteresis") || is_known("lag"));
  EXPECT_LT(diagnosis.error.mae_after, 0.85 * diagnosis.error.mae_before);
  for (const EffectFinding& effect : diagnosis.effects) {
    double largest = 0;
    for (const ParameterFinding& p : effect.parameters) {
      if (p.name == "presliding" || p.name == "late")
        largest = std::max(largest, std::abs(p.value));
    }
    // The Coulomb friction there is 0.25 A: nothing builds up to more than that.
    EXPECT_LT(largest, 0.3) << effect.family;
  }
  // Nothing is said twice.
  std::vector<std::string> notes = diagnosis.notes;
  std::ranges::sort(notes);
  EXPECT_TRUE(std::ranges::adjacent_find(notes) == notes.end());
}

TEST(JudgedDiagnosis, IsTheSameAgain) {
  const kuka::PlantedCase planted{.effects = {{"load_coulomb", 0.5}}};
  const JudgedDiagnosis one = judge_planted(planted, 8);
  const JudgedDiagnosis two = judge_planted(planted, 8);
  EXPECT_EQ(one.error.mae_after, two.error.mae_after);
  EXPECT_EQ(one.leftover.p, two.leftover.p);
  EXPECT_EQ(families(one), families(two));
  EXPECT_EQ(formula_of(one.after), formula_of(two.after));
}

// In a table of friction alone, too, the gear has carried the inertia behind it.
TEST(JudgedDiagnosis, LoadFrictionOfGravityAndInertiaIsNamedWithoutALeftover) {
  Dataset data = kuka::make_planted({}, 5).data;
  const std::vector<double> v = data.find(Role::velocity)->values;
  const std::vector<double> a = data.find(Role::acceleration)->values;
  const std::vector<double> g = data.find(Role::gravity_torque)->values;
  const double inertia = 2 * std::ranges::max(g) / std::ranges::max(a);
  const auto target = std::ranges::find(data.channels, Role::friction_torque, &Channel::role);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    target->values[i] += 0.1 * std::copysign(g[i] + inertia * a[i], v[i]);
  }
  const JudgedDiagnosis diagnosis = diagnose_and_judge(observe(data), coulomb_viscous_base, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{"load_coulomb"});
}

// At a level that no test of so many flips can reach nothing is named: that something is missing
// shows in the error all the same, where it is.
TEST(JudgedDiagnosis, NothingIsMissingOnlyWhereASmoothModelDoesNoBetter) {
  DiagnosisOptions options;
  options.alpha_library = options.alpha_leftover = 1e-6;
  for (const double size : {0.0, 4.0}) {
    const kuka::PlantedCase planted{.effects = {{"nonlinear_viscous", size}}};
    const JudgedDiagnosis diagnosis =
        diagnose_and_judge(observe(kuka::make_planted(planted, 3).data), coulomb_viscous_base,
                           options, {.bounds = true});
    EXPECT_EQ(families(diagnosis), std::vector<std::string>{});
    EXPECT_EQ(diagnosis.verdict, size > 0 ? Verdict::cannot_tell : Verdict::none);
    EXPECT_EQ(diagnosis.needed.size(), size > 0 ? 1U : 0U);
  }
}

// Of one movement forwards and one backwards neither says anything of the other: whatever the base
// is, it was not looked at.
TEST(JudgedDiagnosis, NothingIsMissingOnlyWhereTheOthersForetellAMovement) {
  const auto verdict = [](int movements) {
    const Dataset data = testing::movements_with_offsets(movements, 0, 3);
    return diagnose_and_judge(observe(data), coulomb_viscous_base, {}).verdict;
  };
  EXPECT_EQ(verdict(2), Verdict::cannot_tell);
  EXPECT_EQ(verdict(4), Verdict::none);
}

// A fall with speed of a twelfth of the noise is found with all movements and not without some.
TEST(JudgedDiagnosis, WhatTheSearchesOnPartsDoNotFindAgainIsNotNamed) {
  const kuka::PlantedCase planted{.effects = {{"stribeck", 0.08}}};
  for (const std::uint64_t seed : {4U, 11U}) {
    EXPECT_EQ(families(judge_planted(planted, seed)), std::vector<std::string>{"stribeck"});
    const JudgedDiagnosis again = judge_planted(planted, seed, {.resample = true});
    EXPECT_EQ(families(again), std::vector<std::string>{}) << seed;
    EXPECT_THAT(again.notes, ::testing::Contains(::testing::HasSubstr("not named"))) << seed;
  }
}

// The same found without the searches on parts that had it at no time: these would say what they
// said.
TEST(JudgedDiagnosis, OnlySearchesThatHadWhatIsNotNamedAreRunAgain) {
  std::size_t ended = 0;
  std::size_t asked = 0;
  const auto progress = [&](std::size_t now, std::size_t searches) {
    ended = now;
    asked = searches;
  };
  const kuka::PlantedCase planted{.effects = {{"stribeck", 0.08}}};
  const JudgedDiagnosis once = judge_planted(planted, 4);
  const JudgedDiagnosis again = judge_planted(planted, 4, {.resample = true, .progress = progress});
  EXPECT_EQ(once.tried, std::vector<std::string>{"stribeck"});
  EXPECT_EQ(families(again), std::vector<std::string>{});
  EXPECT_EQ(ended, asked);
  EXPECT_GT(asked, 1U + 10 + 1);  // the whole, ten parts, the whole again, and some of the parts
  EXPECT_LT(asked, 2U * (1 + 10));
}

// A lag beside which half of the searches see presliding as well: without it, from the start, they
// would see neither.
TEST(JudgedDiagnosis, WhatIsNotNamedTakesNothingElseWithIt) {
  const PlantedData run = simulation::simulate(
      {"lag_of_velocity", 1, simulation::NoiseKind::bursty, simulation::Design::mixed}, 7160098);
  const JudgedDiagnosis diagnosis = diagnose_and_judge(observe(run.data), coulomb_viscous_base,
                                                       {.gear_ratios = {100}}, {.resample = true});
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{"lag"});
  EXPECT_THAT(diagnosis.notes, ::testing::Contains(::testing::HasSubstr("'hysteresis' is chosen")));
  EXPECT_LT(diagnosis.error.mae_after, 0.85 * diagnosis.error.mae_before);
}

// Three waves in the joint's angle, of which a search takes the first and then one that drifts:
// both give way to the wave and its harmonics, and nothing is left to ask for a third column.
TEST(JudgedDiagnosis, AWaveThatSeemedToDriftGivesWayToTheHarmonicsOfTheFirst) {
  const PlantedData run =
      simulation::simulate({"output_ripple_harmonics", 2, simulation::NoiseKind::heteroscedastic,
                            simulation::Design::mixed},
                           7140085);
  const JudgedDiagnosis diagnosis = diagnose_and_judge(observe(run.data), coulomb_viscous_base,
                                                       {.gear_ratios = {100}}, {.resample = true});
  EXPECT_EQ(families(diagnosis), std::vector<std::string>{"output_ripple"});
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  EXPECT_LT(diagnosis.error.mae_after, 0.4 * diagnosis.error.mae_before);
}

// Searches side by side and one after the other: the same, bit for bit.
TEST(JudgedDiagnosis, IsTheSameOnAnyNumberOfThreads) {
  const kuka::PlantedCase planted{.effects = {{"stribeck", 1.0}}};
  const JudgedDiagnosis one = judge_planted(planted, 8, {.resample = true, .threads = 1});
  const JudgedDiagnosis two = judge_planted(planted, 8, {.resample = true, .threads = 2});
  ASSERT_EQ(one.effects.size(), 1U);
  EXPECT_GT(one.effects[0].chosen_share, 0.5);
  EXPECT_EQ(one.effects[0].chosen_share, two.effects.at(0).chosen_share);
  EXPECT_EQ(one.error.difference_low, two.error.difference_low);
}

// The searches without some movements begin beside the first, and where that names nothing their
// number hangs on the threads and on what else the machine does; the answer does not.
TEST(JudgedDiagnosis, WhereNothingIsNamedWhatBeganBesideItIsForgotten) {
  for (const int threads : {1, 2}) {
    std::size_t ended = 0;
    const auto progress = [&](std::size_t now, std::size_t) { ended = now; };
    const JudgedDiagnosis nothing =
        judge_planted({}, 8, {.resample = true, .threads = threads, .progress = progress});
    EXPECT_EQ(nothing.verdict, Verdict::none);
    EXPECT_LT(ended, threads == 1 ? 2U : 11U) << "of eleven";
    EXPECT_EQ(nothing.error.mae_after, nothing.error.mae_before);
  }
}

// Strokes at constant speeds, half of them backwards, with Coulomb and viscous friction and noise.
Observations strokes(int movements, int rows = 40, double noise = 0.3) {
  RandomStream random(5);
  Dataset data;
  data.channels = {{"v", "rad/s", Role::velocity, {}}, {"tau", "N m", Role::friction_torque, {}}};
  for (int m = 0; m < movements; ++m) {
    data.movement_names.push_back("m" + std::to_string(m));
    const double v = (m % 2 == 0 ? 1 : -1) * (0.1 + 0.01 * m);
    for (int i = 0; i < rows; ++i) {
      const double speed = v * (1 + 0.4 * i / rows);
      data.channels[0].values.push_back(speed);
      data.channels[1].values.push_back((v > 0 ? 5 : -5) + 3 * speed + noise * random.normal());
      data.movement.push_back(m);
    }
  }
  return observe(data);
}

JudgedDiagnosis diagnose_strokes(const Observations& data, const JudgingOptions& judging = {}) {
  DiagnosisOptions options;
  options.families = {"stribeck"};
  return diagnose_and_judge(data, coulomb_viscous_base, options, judging);
}

JudgedDiagnosis diagnose_strokes(int movements, const JudgingOptions& judging = {}) {
  return diagnose_strokes(strokes(movements), judging);
}

// Forty movements are enough to hold some out, thirty to tell what differs between them.
TEST(JudgedDiagnosis, JudgesFewMovementsInTurnAndSaysWhereTheyAreTooFew) {
  const auto wanted = ::testing::Contains(::testing::AllOf(::testing::HasSubstr("there are 29"),
                                                           ::testing::HasSubstr("30 are wanted")));
  const JudgedDiagnosis few = diagnose_strokes(29);
  EXPECT_THAT(few.notes, wanted);
  EXPECT_EQ(few.error.how, "each movement left out in turn");
  EXPECT_EQ(few.error.test_movements, 29U);
  EXPECT_THAT(diagnose_strokes(30).notes,
              ::testing::Not(::testing::Contains(::testing::HasSubstr("are wanted"))));
  EXPECT_EQ(diagnose_strokes(37).error.how, "each movement left out in turn");
  const JudgedDiagnosis many = diagnose_strokes(40);
  EXPECT_EQ(many.error.how, "held out");
  EXPECT_EQ(many.error.test_movements, 8U);
  EXPECT_THAT(many.held_out, ::testing::SizeIs(8));
}

TEST(JudgedDiagnosis, JudgesOneMovementByPiecesOfIt) {
  const JudgedDiagnosis one = diagnose_strokes(1);
  EXPECT_EQ(one.error.judged_on, JudgedOn::pieces_of_movements);
  EXPECT_EQ(one.error.how, "pieces of the movements left out in turn");
  // 40 rows are eight pieces of five, of which nine would be too short for a movement.
  ASSERT_THAT(one.error.movements, ::testing::SizeIs(8));
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(one.error.movements[static_cast<std::size_t>(k)].movement, k);
    EXPECT_EQ(one.error.movements[static_cast<std::size_t>(k)].rows, 5U);
  }
  EXPECT_THAT(one.notes, ::testing::Contains(::testing::HasSubstr("there is one movement")));
}

// Without one of two the other alone would tell effects from time, of which it says nothing.
TEST(JudgedDiagnosis, JudgesTwoMovementsByPiecesThatHoldRowsOfOne) {
  const JudgedDiagnosis two = diagnose_strokes(2);
  EXPECT_EQ(two.error.judged_on, JudgedOn::pieces_of_movements);
  EXPECT_THAT(two.error.movements, ::testing::SizeIs(10));
  EXPECT_THAT(two.notes, ::testing::Contains(::testing::HasSubstr("there are 2 movements")));
  EXPECT_EQ(diagnose_strokes(3).error.how, "each movement left out in turn");
}

TEST(JudgedDiagnosis, TellsItsProgressSearchBySearch) {
  std::vector<std::size_t> ended;
  const auto progress = [&](std::size_t now, std::size_t searches) {
    ended.push_back(now);
    EXPECT_EQ(searches, 7U);  // one with all movements, six without one
  };
  diagnose_strokes(6, {.progress = progress});
  EXPECT_EQ(ended, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7}));
}

// Of many rows a tenth of the movements at a time.
TEST(JudgedDiagnosis, LeavesOutSeveralMovementsTogetherWhereRowsAreMany) {
  std::size_t searches = 0;
  const auto progress = [&](std::size_t, std::size_t all) { searches = all; };
  const JudgedDiagnosis many = diagnose_strokes(strokes(12, 600), {.progress = progress});
  EXPECT_EQ(many.error.how, "the movements left out in 10 turns");
  EXPECT_EQ(searches, 1U + 10);
  EXPECT_EQ(many.error.test_movements, 12U);
}

// Movements of one group say little of each other: each group is judged by models of the others.
TEST(JudgedDiagnosis, LeavesOutTheMovementsOfAGroupTogether) {
  Observations data = strokes(48);
  for (int m = 0; m < 48; ++m) data.group.push_back(m / 8);
  data.group_name = "payload";
  EXPECT_TRUE(held_out_movements(data, 0.2).empty());
  std::size_t searches = 0;
  const auto progress = [&](std::size_t, std::size_t all) { searches = all; };
  const JudgedDiagnosis judged = diagnose_strokes(data, {.progress = progress});
  EXPECT_EQ(judged.error.how, "movements of one 'payload' left out in turn");
  EXPECT_EQ(searches, 1U + 6);
  EXPECT_EQ(judged.error.test_movements, 48U);
}

// One movement lies 20 N m above the others. A model that has seen it is wrong everywhere by the
// share that it gives to it; of the model that judges it nothing has.
TEST(JudgedDiagnosis, JudgesAMovementByModelsThatHaveNotSeenIt) {
  Observations data = strokes(4);
  for (std::size_t i = 0; i < data.rows(); ++i) data.target[i] += data.movement[i] == 2 ? 20 : 0;
  const JudgedDiagnosis judged = diagnose_strokes(data);
  ASSERT_EQ(judged.error.movements.size(), 4U);
  EXPECT_NEAR(judged.error.movements[2].before, 20, 0.5);
}

// Hardly any noise: each row's error is that of its own prediction, in the first row of the data
// and beside a reversal too.
TEST(JudgedDiagnosis, ComparesEachRowWithItsOwnPrediction) {
  const JudgedDiagnosis in_turn = diagnose_strokes(strokes(8, 40, 1e-3));
  EXPECT_LT(in_turn.error.max_before, 0.01);
  EXPECT_NEAR(in_turn.error.mae_before, 1e-3 * std::sqrt(2 / 3.14159265), 1e-4);
  EXPECT_EQ(in_turn.error.movements.at(0).rows, 40U);
  const JudgedDiagnosis held_out = diagnose_strokes(strokes(44, 40, 1e-3), {.bounds = true});
  EXPECT_LT(held_out.error.max_before, 0.01);
  EXPECT_LT(held_out.error.attainable, 1.1e-3);
}

// Presliding, and bounds of the noise, are judged where they are; NaN says that they are not.
TEST(JudgedDiagnosis, HasNoFiguresOfWhatWasNotFoundOrNotAskedFor) {
  const JudgedDiagnosis judged = diagnose_strokes(40);
  EXPECT_FALSE(judged.bristles);
  EXPECT_TRUE(std::isnan(judged.error.mae_state));
  EXPECT_TRUE(std::isnan(judged.error.ceiling));
  EXPECT_TRUE(judged.effects.empty());
  EXPECT_TRUE(judged.error.confirmed);
  EXPECT_EQ(judged.error.judged_on, JudgedOn::other_movements);
  EXPECT_NEAR(judged.error.mae_after, 0.3 * std::sqrt(2 / 3.14159265), 0.03);
  const JudgedDiagnosis bounded = diagnose_strokes(40, {.bounds = true});
  EXPECT_FALSE(std::isnan(bounded.error.ceiling));
  EXPECT_EQ(bounded.error.mae_after, judged.error.mae_after);
}

TEST(HeldOutMovements, AreTheShareThatIsAskedForInAscendingOrder) {
  const std::vector<int> fifth = held_out_movements(strokes(50), 0.2);
  EXPECT_THAT(fifth, ::testing::SizeIs(10));
  EXPECT_TRUE(std::ranges::is_sorted(fifth));
  EXPECT_THAT(held_out_movements(strokes(50), 0.5), ::testing::SizeIs(25));
  EXPECT_THAT(held_out_movements(strokes(39), 0.2), ::testing::IsEmpty());
  EXPECT_THAT(held_out_movements(strokes(40), 0.2), ::testing::SizeIs(8));
}

}  // namespace
}  // namespace tribench::loop
