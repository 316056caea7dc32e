// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "algorithms/exploration/fixed_plans.hpp"
#include "algorithms/exploration/recorded_movements.hpp"
#include "foundation/error.hpp"
#include "foundation/freed_memory.hpp"
#include "foundation/sign.hpp"
#include "problems/joint_simulation/world.hpp"

namespace tribench::loop {
namespace {

// As the program does when it starts: pages mapped anew would take two fifths of the time.
const bool kKeepsFreedMemory = [] {
  keep_freed_memory();
  return true;
}();

std::vector<std::string> left_by(const Exploration& done) {
  std::vector<std::string> verdicts;
  for (const WeighedVerdict& one : done.left) verdicts.push_back(one.verdict);
  return verdicts;
}

Exploration explored(std::uint64_t seed, simulation::WorldKind kind, std::string_view plan,
                     double budget_s = 600, double smallest_effect = kSmallestEffect) {
  simulation::World world({seed, simulation::WorldLevel::easy, kind});
  ExplorerOptions options;
  options.budget_s = budget_s;
  options.smallest_effect = smallest_effect;
  return explore(
      world.limits(),
      [&](const PlannedMovement& movement) { return world.execute(movement, "the plan"); }, options,
      find_plan(plan).make(seed));
}

TEST(Explorer, NamesWhatAnEasyWorldHides) {
  const simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
  const Exploration done =
      explored(3, simulation::WorldKind::single, "informative", 600, world.smallest_effect());
  ASSERT_EQ(done.end, ExplorationEnd::sure);
  ASSERT_FALSE(done.families.empty());
  EXPECT_FALSE(done.unknown);
  for (const std::string& family : done.families) {
    const PlantedEffect& truth = world.truth().effects[0];
    EXPECT_TRUE(std::ranges::count(truth.names, family) + std::ranges::count(truth.beside, family))
        << family << " for " << truth.family;
  }
  EXPECT_GE(done.log_e_value, std::log(100));
  EXPECT_GE(done.weight, 0.99);
}

// With one load alone a wrong gain of the gravity torque is a payload: no movement tells them
// apart.
TEST(Explorer, SaysWhatItsLimitsDoNotLetItTellApart) {
  const auto end = [](bool may_load) {
    simulation::World world({23, simulation::WorldLevel::easy, simulation::WorldKind::single});
    EXPECT_EQ(world.truth().effects[0].family, "gravity_wrong");
    MotionLimits limits = world.limits();
    if (!may_load) limits.least_load_factor = limits.greatest_load_factor = 1;
    ExplorerOptions options;
    options.budget_s = 80;
    return explore(
        limits,
        [&](const PlannedMovement& movement) { return world.execute(movement, "the plan"); },
        options, informative_movements());
  };
  const Exploration alike = end(false);
  EXPECT_NE(alike.end, ExplorationEnd::sure);
  EXPECT_THAT(left_by(alike), ::testing::IsSupersetOf({"payload", "power_quadrant_gain"}));
  EXPECT_THAT(left_by(end(true)), ::testing::Not(::testing::Contains("payload")));
}

TEST(Explorer, AsksTheSameAgain) {
  const Exploration first = explored(3, simulation::WorldKind::single, "informative", 22);
  const Exploration again = explored(3, simulation::WorldKind::single, "informative", 22);
  EXPECT_GT(first.weight, 0);
  EXPECT_EQ(again.seconds, first.seconds);
  EXPECT_EQ(again.weight, first.weight);
  EXPECT_EQ(again.steps.size(), first.steps.size());
}

TEST(Explorer, KeepsToItsSeconds) {
  for (const NamedPlan& plan : movement_plans()) {
    const Exploration done = explored(8, simulation::WorldKind::none, plan.name, 30);
    EXPECT_LE(done.seconds, 30) << plan.name;
    EXPECT_GE(done.steps.size(), 1U) << plan.name;  // a slow sweep takes long
    EXPECT_NE(done.end, ExplorationEnd::sure) << plan.name;
    double sum = 0;
    for (const ExplorationStep& step : done.steps) sum += step.cost_s;
    EXPECT_NEAR(sum, done.seconds, 1e-9);
  }
}

// What is driven between two movements is not recorded.
TEST(Explorer, OpensWithMovementsThatBeginWhereTheLastOneEnded) {
  const Exploration done = explored(3, simulation::WorldKind::single, "informative", 25);
  std::size_t opening = 1;
  for (; opening < done.steps.size() && done.steps[opening].why == "opening"; ++opening) {
    EXPECT_NEAR(start_of(done.steps[opening].movement), end_of(done.steps[opening - 1].movement),
                0.01)
        << opening;
  }
  EXPECT_EQ(opening, 5U);
}

TEST(Explorer, AsksForSomethingElseWhereAMovementIsRefused) {
  simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
  ExplorerOptions options;
  options.budget_s = 30;
  std::size_t refused = 0;
  const Exploration done = explore(
      world.limits(),
      [&](const PlannedMovement& movement) {
        if (movement.load_factor > 1) {
          ++refused;
          throw Error(ErrorKind::bad_input, "no payload today");
        }
        return world.execute(movement, "the plan");
      },
      options, informative_movements());
  EXPECT_EQ(done.refused.size(), refused);
  EXPECT_GE(done.steps.size(), 6U);
  for (const ExplorationStep& step : done.steps) EXPECT_LE(step.movement.load_factor, 1);
}

// Rows at 1 kHz say what rows at 12.5 Hz say, and would fill the memory.
TEST(Explorer, ForeseesNoMoreRowsOfAFasterRecording) {
  const auto foreseen_at = [](double rate_hz) {
    simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
    MotionLimits limits = world.limits();
    limits.rate_hz = rate_hz;
    ExplorerOptions options;
    options.budget_s = 30;
    std::pair<double, double> rows{0, 0};  // foreseen, and that they stand for
    const MovementPlan plan = informative_movements();
    explore(
        limits,
        [&](const PlannedMovement& movement) { return world.execute(movement, "the plan"); },
        options,
        [&](const ExplorationState& state) {
          rows = {0, 0};
          for (const MovementRows& one : state.foreseen.movements) {
            rows.first += static_cast<double>(one.rows.size());
            rows.second += one.counts * static_cast<double>(one.rows.size());
          }
          return plan(state);
        });
    return rows;
  };
  const auto usual = foreseen_at(12.5);
  const auto fast = foreseen_at(250);
  EXPECT_GT(usual.first, 1000);
  EXPECT_NEAR(fast.first / usual.first, 1, 0.1);
  EXPECT_NEAR(fast.second / usual.second, 20, 2);
}

// As the simulated joint records them, one after the other.
Dataset recorded(simulation::World& world, std::span<const PlannedMovement> movements) {
  Dataset all;
  for (const PlannedMovement& movement : movements) {
    append_movement(all, world.execute(movement, "the plan"));
  }
  return all;
}

std::vector<PlannedMovement> some_movements(const MotionLimits& limits) {
  std::vector<PlannedMovement> all;
  for (const double part : {0.1, 0.3, 0.6, 0.9}) {
    for (const double direction : {1.0, -1.0}) {
      all.push_back(constant_movement(direction * part * limits.speed_rad_s, -0.8, 0.8, 1));
    }
    all.push_back(two_tone_movement(part * limits.speed_rad_s, -0.2, 0.2, 1));
  }
  return all;
}

TEST(Assessor, MovementsAddedOneByOneSayWhatTheySayTogether) {
  simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
  const Dataset data = recorded(world, some_movements(world.limits()));
  const Observations rows = observe(data);
  const ExplanationSpace space(rows, {100});
  Assessor together(space, 0.01);
  together.add(rows);
  together.look();
  Assessor grown(space, 0.01);
  for (const int m : rows.movements()) {
    std::vector<char> own;
    for (const int movement : rows.movement) own.push_back(movement == m ? 1 : 0);
    grown.add(rows.select(own));
    if (m >= 8) grown.look();
  }
  EXPECT_EQ(grown.movements(), together.movements());
  EXPECT_EQ(grown.last().sums.rows(), together.last().sums.rows());
  together.look();  // what is noise is known from the second look on
  EXPECT_EQ(grown.look().best().verdict, together.last().best().verdict);
  EXPECT_NEAR(grown.last().best().log_evidence / together.last().best().log_evidence, 1, 0.1);
}

// What nobody cares for need not be ruled out.
TEST(Assessor, IsTheSurerThatNothingIsMissingTheLargerTheSmallestEffect) {
  simulation::World world({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const auto doubt = [&](double smallest_effect) {
    const ExplanationSpace space(rows, {100}, smallest_effect);
    Assessor assessor(space, 0.01);
    assessor.add(rows);
    return 1 - assessor.look().weight_of("NONE");
  };
  EXPECT_LT(doubt(2), 0.5 * doubt(1));
  EXPECT_LT(doubt(1), 0.5 * doubt(0.25));
}

// Something narrow at standstill is what the library calls a Stribeck curve, and nothing else.
TEST(Assessor, AStribeckCurveIsNotSomethingElseOfTheVelocity) {
  simulation::World world({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
  Observations rows = observe(recorded(world, some_movements(world.limits())));
  const std::vector<double>& v = rows.find("v")->values;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    rows.target[i] += 1.5 * sign(v[i]) * std::exp(-v[i] * v[i] / (0.08 * 0.08));
  }
  const ExplanationSpace space(rows, {100});
  Assessor assessor(space, 0.01);
  assessor.add(rows);
  EXPECT_GT(assessor.look().weight_of("stribeck"), 30 * assessor.look().weight_of("UNKNOWN"));
}

Observations rows_that_lack_nothing() {
  simulation::World world({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
  return observe(recorded(world, some_movements(world.limits())));
}

double weight_in(const Observations& rows, const std::string& verdict, double smallest_effect) {
  const ExplanationSpace space(rows, {100}, smallest_effect);
  Assessor assessor(space, 0.01);
  assessor.add(rows);
  assessor.look();
  return assessor.look().weight_of(verdict);
}

// Beside Coulomb and viscous friction a viscous curve upside down falls as Stribeck's does.
TEST(Assessor, FrictionThatFallsIsAStribeckCurve) {
  Observations rows = rows_that_lack_nothing();
  const std::vector<double>& v = rows.find("v")->values;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    rows.target[i] += 6 * sign(v[i]) * std::exp(-v[i] * v[i] / (0.12 * 0.12));
  }
  const double stribeck = weight_in(rows, "stribeck", 0.5);
  EXPECT_GT(stribeck, 0.5);
  EXPECT_GT(stribeck, 10 * weight_in(rows, "nonlinear_viscous", 0.5));
}

// Where the smallest effect of interest is small, one that is a hundred times larger is itself as
// well, and whether there is something small beside it is nearly as open as without it.
TEST(Assessor, AnEffectManyTimesTheSmallestIsOneEffect) {
  Observations rows = rows_that_lack_nothing();
  const double without = weight_in(rows, "NONE", 0.3);
  const std::vector<double>& g = rows.find("g")->values;
  const std::vector<double>& v = rows.find("v")->values;
  for (std::size_t i = 0; i < rows.rows(); ++i) rows.target[i] += 0.4 * std::abs(g[i]) * sign(v[i]);
  const double with = weight_in(rows, "load_coulomb", 0.3);
  EXPECT_GT(with, 0.5);
  EXPECT_GT(with, 0.6 * without);
}

// A sensor that was late, a lost message, a velocity of the wrong sign.
TEST(Assessor, ARowThatIsWrongIsNoEffect) {
  Observations rows = rows_that_lack_nothing();
  const double without = weight_in(rows, "NONE", 1);
  const std::vector<double>& v = rows.find("v")->values;
  const auto slowest = std::ranges::min_element(v, {}, [](double x) { return std::abs(x); });
  rows.target[static_cast<std::size_t>(slowest - v.begin())] *= -60;
  EXPECT_GT(without, 0.5);
  EXPECT_GT(weight_in(rows, "NONE", 1), 0.8 * without);
}

// A notch where nobody has been may be there however much was recorded elsewhere.
TEST(Assessor, RulesNothingOutAtPositionsThatNoRowWasNear) {
  simulation::World world({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
  std::vector<PlannedMovement> everywhere = some_movements(world.limits());
  std::vector<PlannedMovement> above;
  for (PlannedMovement one : everywhere) {
    if (!one.is_two_tone()) (one.velocity > 0 ? one.from : one.to) = 0;
    above.push_back(one);
  }
  const ExplanationSpace space(observe(recorded(world, everywhere)), {100});
  const auto evidence = [&](const std::vector<PlannedMovement>& movements) {
    simulation::World again({8, simulation::WorldLevel::easy, simulation::WorldKind::none});
    Assessor assessor(space, 0.01);
    assessor.add(observe(recorded(again, movements)));
    const std::vector<Explanation>& all = assessor.look().explanations;
    return std::ranges::find_if(all,
                                [&](const Explanation& one) {
                                  return one.families.size() == 1 &&
                                         space.families()[one.families[0]].name ==
                                             "unknown:position";
                                })
        ->log_evidence;
  };
  EXPECT_GT(evidence(above), evidence(everywhere) + 1);
}

// A further effect costs a share of its own and the number of those it may be, whatever is there.
TEST(Explanations, AreAsLikelyBeforehandAsOthersOfAsManyEffects) {
  simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const ExplanationSpace space(rows, {100});
  Assessor assessor(space, 0.01);
  assessor.add(rows);
  std::map<std::pair<std::size_t, bool>, double> known;  // of so many effects, one of no library
  for (const Explanation& one : assessor.look().explanations) {
    const bool unknown = std::ranges::any_of(
        one.families, [&](std::size_t f) { return space.families()[f].unknown; });
    const auto [place, is_new] = known.try_emplace({one.families.size(), unknown}, one.log_prior);
    EXPECT_DOUBLE_EQ(one.log_prior, place->second) << one.verdict;
  }
  const double third = known.at({2, false}) - known.at({3, false});
  const double second = known.at({1, false}) - known.at({2, false});
  EXPECT_GT(third, second);
  EXPECT_LT(third, second + std::log(10));
}

// What lives in time has columns for the reference's times alone.
TEST(Plans, NoRestIsAskedForThatLeadsBeyondTheTimesOfTheReferenceOrTellsMoreThanIsNeeded) {
  simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::none});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const ExplanationSpace space(rows, {100});
  Assessor assessor(space, 0.01);
  assessor.add(rows);
  std::vector<PlannedMovement> candidates(2, some_movements(world.limits()).front());
  candidates[0].rest = world.limits().longest_rest_s;
  // What comes after the rest would tell a thousand times as much.
  const Foreseen foreseen{space.base_columns(rows),
                          space.columns(rows),
                          {{{0, rows.rows()}, 1000}, {{0, rows.rows()}, 1}}};
  const auto asked_at = [&](double time_s, double alpha) {
    ExplorerOptions options;
    options.alpha = alpha;
    const Exploration nothing_yet;
    const ExplorationState state{world.limits(),   options,  nothing_yet,
                                 &assessor.look(), {time_s}, candidates,
                                 foreseen,         {0, 0},   ""};
    return informative_movements()(state).value().movement.rest;
  };
  const double far = 1e-200;  // a level for which neither tells enough
  EXPECT_EQ(asked_at(100, far), world.limits().longest_rest_s);
  EXPECT_EQ(asked_at(world.limits().seconds - 60, far), 0);
  // Where what comes without a rest is enough, nobody waits to hear more.
  const double others = 1 - assessor.look().weight_of(assessor.last().best().verdict);
  EXPECT_EQ(asked_at(100, others), 0);
}

// What a row's columns are does not hang on other movements: else sums could not grow.
TEST(ExplanationSpace, AMovementHasItsColumnsWhateverIsBesideIt) {
  simulation::World world({5, simulation::WorldLevel::easy});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const ExplanationSpace space(rows, {100});
  const RowRange own = make_clusters(rows.movement, 1).movements[2];
  std::vector<char> few(rows.rows(), 0);
  std::fill(few.begin() + static_cast<std::ptrdiff_t>(own.begin),
            few.begin() + static_cast<std::ptrdiff_t>(own.end), 1);
  const Eigen::MatrixXd alone = space.columns(rows.select(few));
  const Eigen::MatrixXd there =
      space.columns(rows).middleRows(static_cast<Eigen::Index>(own.begin), alone.rows());
  EXPECT_LE((alone - there).cwiseAbs().maxCoeff(), 1e-10);
}

// A slow oscillation, of which the first half minute shows nothing.
TEST(Explorer, WaitsBeforeItIsSureThatNothingLivesInTime) {
  simulation::World world({172068, simulation::WorldLevel::medium});
  ASSERT_EQ(world.truth().effects[0].family, "slow_oscillation");
  ExplorerOptions options;
  options.budget_s = 50;
  options.smallest_effect = world.smallest_effect();
  const Exploration done = explore(
      world.limits(),
      [&](const PlannedMovement& movement) { return world.execute(movement, "the plan"); }, options,
      informative_movements());
  EXPECT_FALSE(done.end == ExplorationEnd::sure && done.verdict == "NONE");
  EXPECT_TRUE(std::ranges::any_of(done.steps, [](const ExplorationStep& step) {
    return step.movement.rest > 0;
  })) << "it never waited";
}

// Its shape is none of the library's: the misfit is its own, and no reason to name another family.
TEST(Explorer, ALagIsToldWithoutAStribeckEffect) {
  const simulation::World world({59, simulation::WorldLevel::easy, simulation::WorldKind::single});
  ASSERT_EQ(world.truth().effects[0].family, "lag_of_friction");
  const Exploration done =
      explored(59, simulation::WorldKind::single, "informative", 90, world.smallest_effect());
  EXPECT_EQ(done.end, ExplorationEnd::sure);
  EXPECT_FALSE(done.unknown);
  EXPECT_THAT(done.families, ::testing::IsSubsetOf({"lag", "hysteresis", "inertia"}));
}

TEST(RecordedMovements, LongOnesAreCutAndKeepTheirRows) {
  simulation::World world({5, simulation::WorldLevel::easy});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const Observations cut = cut_movements(rows, 6);
  EXPECT_GT(cut.movements().size(), rows.movements().size());
  EXPECT_EQ(cut.target, rows.target);
  EXPECT_TRUE(std::ranges::is_sorted(cut.movement));
  EXPECT_EQ(cut_movements(rows, 1e6).movement_names.size(), rows.movements().size());
}

// It gets so warm that every movement would be refused, and rests instead of giving up.
TEST(Explorer, RestsWhereAMovementIsRefused) {
  simulation::World world({3, simulation::WorldLevel::easy, simulation::WorldKind::single});
  ExplorerOptions options;
  options.budget_s = 60;
  std::size_t rested = 0;
  const Exploration done = explore(
      world.limits(),
      [&](const PlannedMovement& movement) {
        const bool rests = movement.rest > 0;
        if (!rests && world.movements() >= 6) {
          throw Error(ErrorKind::bad_input, "the housing would be too warm");
        }
        rested += rests ? 1 : 0;
        return world.execute(movement, "the plan");
      },
      options, informative_movements());
  EXPECT_GE(done.seconds, 50);
  EXPECT_GE(rested, 3U);
}

TEST(RecordedMovements, AreAskedForUntilTheyMakeTheVerdictOfAll) {
  simulation::World world({5, simulation::WorldLevel::easy});
  const Observations rows = observe(recorded(world, some_movements(world.limits())));
  const auto enough = [](const Observations& asked) {
    return std::string(asked.movements().size() >= 5 ? "enough" : "more");
  };
  const AskedRecordings asked = ask_for_recordings(rows, {100}, 0.01, enough, "enough");
  ASSERT_EQ(asked.path.size(), 5U);
  std::vector<std::size_t> movements;
  for (const AskedMovement& one : asked.path) movements.push_back(one.movement);
  std::ranges::sort(movements);
  EXPECT_EQ(std::ranges::adjacent_find(movements), movements.end());
  const AskedRecordings drawn = draw_recordings(rows, enough, "never", 7);
  EXPECT_EQ(drawn.path.size(), rows.movements().size());
  EXPECT_GT(drawn.seconds(), asked.seconds());
}

TEST(Plans, AskForNoPlaceAtWhichGravityAloneIsOverTheTorque) {
  MotionLimits limits;
  limits.gravity_nm = 30;
  limits.torque_nm = 20;
  const std::vector<PlannedMovement> all = candidate_movements(limits, 30);
  EXPECT_GT(all.size(), 10U);
  for (const PlannedMovement& one : all) {
    for (const double q : {one.from, one.to}) {
      EXPECT_LE(30 * one.load_factor * std::abs(std::sin(q)), 20);
    }
  }
}

TEST(Plans, AnUnknownNameIsAnsweredWithTheNearest) {
  try {
    find_plan("sweeep");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("sweep"));
  }
}

}  // namespace
}  // namespace tribench::loop
