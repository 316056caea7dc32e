// SPDX-License-Identifier: MIT
//
// The behaviour that is published and can be checked against numbers: shares of the mutations,
// ranks of tournaments, acceptance, the window of frequencies, migration, selection.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/hall_of_fame.hpp"
#include "algorithms/pysr/migration.hpp"
#include "algorithms/pysr/mutation.hpp"
#include "algorithms/pysr/selection.hpp"
#include "algorithms/pysr/tournament.hpp"

namespace tribench::pysr::published_behaviour_test {
namespace {

RandomStream stream(std::string_view name) { return RandomStream(key_of(name)); }

const std::vector<std::string> kNames = {"x", "y"};

Member member(double cost, int size, std::uint64_t birth) {
  return {Expression::constant(cost), cost, cost, size, birth};
}

TEST(PublishedBehaviour, MutationsAreDrawnInThePublishedShares) {
  // Shares in percent of the sum of the published weights (the specification's table 2.4).
  const std::array<double, 11> shares = {50.0, 29.0, 10.2, 3.4,   3.2,  2.3,
                                         1.2,  0.4,  0.13, 0.025, 0.006};
  const MutationWeights weights = published_weights(Profile::v2);
  RandomStream random = stream("shares");
  constexpr int kDraws = 1'000'000;
  std::array<int, kMutationKinds> counts{};
  for (int i = 0; i < kDraws; ++i) ++counts[index_of(draw_kind(weights, random))];
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t kind = 0; kind < shares.size(); ++kind) {
    const double expected = kDraws * weights[kind] / total;
    EXPECT_NEAR(counts[kind], expected, 5 * std::sqrt(expected)) << "kind " << kind;
    EXPECT_NEAR(100 * weights[kind] / total, shares[kind], 0.06) << "kind " << kind;
  }
  EXPECT_EQ(counts[index_of(MutationKind::grow)], 0);
}

TEST(PublishedBehaviour, WeightsAreConditionedOnTheParent) {
  using enum MutationKind;
  const MutationWeights weights = published_weights(Profile::v2);
  const auto of = [&](const char* text, int max_size, std::size_t inputs) {
    const Expression parent = parse(text, kNames);
    return conditioned(weights, parent, static_cast<int>(parent.size()), max_size, inputs);
  };
  const MutationWeights variable = of("x", 30, 2);
  EXPECT_EQ(variable[index_of(mutate_operator)], 0);
  EXPECT_EQ(variable[index_of(delete_node)], 0);
  EXPECT_EQ(variable[index_of(mutate_constant)], 0);
  EXPECT_EQ(variable[index_of(mutate_feature)], weights[index_of(mutate_feature)]);
  EXPECT_EQ(of("2", 30, 2)[index_of(mutate_feature)], 0);
  EXPECT_EQ(of("exp(x)", 30, 2)[index_of(swap_operands)], 0);
  EXPECT_EQ(of("x + y", 30, 1)[index_of(mutate_feature)], 0);
  EXPECT_EQ(of("x + y", 3, 2)[index_of(add_node)], 0);
  EXPECT_DOUBLE_EQ(of("x * 2 + 3", 30, 2)[index_of(mutate_constant)],
                   weights[index_of(mutate_constant)] * 2 / 8);
}

TEST(PublishedBehaviour, TournamentsAreWonByRankWithTheGeometricShares) {
  RandomStream random = stream("ranks");
  constexpr int kDraws = 1'000'000;
  std::array<int, 15> wins{};
  for (int i = 0; i < kDraws; ++i) ++wins[draw_rank(15, 0.982, random)];
  EXPECT_NEAR(wins[0], 982'000, 5 * std::sqrt(982'000 * 0.018));
  EXPECT_NEAR(wins[1], 17'676, 5 * std::sqrt(17'676));
  EXPECT_NEAR(wins[2], 318, 5 * std::sqrt(318));
}

TEST(PublishedBehaviour, ATournamentOfAllPicksTheLowestAdjustedCost) {
  Options options;
  options.tournament_size = 3;
  options.tournament_probability = 1;
  SizeFrequencies frequencies(10);
  for (int i = 0; i < 80; ++i) frequencies.count(3);  // 81 of 90: share 0.9; others 1 / 90
  frequencies.normalise();
  const std::vector<Member> members = {member(1.0, 3, 0), member(2.0, 5, 1), member(50.0, 7, 2)};
  RandomStream random = stream("tournament");
  options.adaptive_parsimony = 0;
  EXPECT_EQ(run_tournament(members, frequencies, options, random), 0u);
  // 1 * exp(2 * 0.9) = 6.05 against 2 * exp(2 / 90) = 2.04.
  options.adaptive_parsimony = 2;
  EXPECT_EQ(run_tournament(members, frequencies, options, random), 1u);
}

TEST(PublishedBehaviour, TheOldestMemberIsTheOneBornFirst) {
  const std::vector<Member> members = {member(1, 1, 7), member(9, 1, 3), member(5, 1, 4)};
  EXPECT_EQ(oldest_of(members), 1u);
}

TEST(PublishedBehaviour, AcceptanceIsTheAnnealingFactorTimesTheRatioOfFrequencies) {
  Options options;
  SizeFrequencies frequencies(4);
  for (int i = 0; i < 5; ++i) frequencies.count(1);  // counts 6, 1, 2, 1 of 10
  frequencies.count(3);
  frequencies.normalise();
  // exp(-(0.7 - 0.2) / (0.5 * 3.17)) * 0.6 / 0.2
  EXPECT_NEAR(acceptance(0.7, 0.2, 3, 1, 0.5, frequencies, options), 3 * 0.7294551, 1e-6);
  // A size out of range counts as 1e-6.
  EXPECT_NEAR(acceptance(0.2, 0.2, 9, 1, 1, frequencies, options), 0.6 / 1e-6, 1);
  options.annealing = false;
  EXPECT_NEAR(acceptance(9, 0.2, 1, 3, 0.5, frequencies, options), 1.0 / 3, 1e-12);
}

TEST(PublishedBehaviour, AtTemperatureZeroOnlyChildrenThatAreNoWorseAreAccepted) {
  Options options;
  options.use_frequency = false;
  const SizeFrequencies frequencies(4);
  RandomStream random = stream("zero");
  EXPECT_FALSE(accepts(acceptance(2, 1, 1, 1, 0, frequencies, options), random));
  EXPECT_TRUE(accepts(acceptance(1, 2, 1, 1, 0, frequencies, options), random));
  const double equal = acceptance(1, 1, 1, 1, 0, frequencies, options);
  EXPECT_TRUE(std::isnan(equal));
  EXPECT_TRUE(accepts(equal, random));
}

TEST(PublishedBehaviour, TheWindowOfFrequenciesLowersNoCountBelowOne) {
  SizeFrequencies frequencies(4);
  for (int i = 0; i < 100; ++i) frequencies.count(1);
  for (int i = 0; i < 2; ++i) frequencies.count(2);
  frequencies.shrink_to(50);  // 101 + 3 + 1 + 1 = 106: lower by 56
  const std::vector<double>& counts = frequencies.counts();
  EXPECT_NEAR(std::accumulate(counts.begin(), counts.end(), 0.0), 50, 1e-9);
  EXPECT_DOUBLE_EQ(counts[1], 1);
  EXPECT_NEAR(counts[0], 47, 1e-9);
  EXPECT_DOUBLE_EQ(counts[3], 1);
}

TEST(PublishedBehaviour, MigrationReplacesAsManyAsPoissonSays) {
  struct Case {
    double fraction;
    double expected;
  };
  for (const auto& [fraction, expected] :
       {Case{0.00036, 0.00972}, Case{0.0614, 1.6578}, Case{0.001, 0.027}}) {
    RandomStream random = stream("migration");
    std::vector<Member> members(27, member(1, 1, 0));
    const std::vector<Member> migrants = {member(0.5, 2, 0), member(0.4, 3, 0)};
    std::uint64_t clock = 0;
    constexpr int kRounds = 200'000;
    for (int i = 0; i < kRounds; ++i) migrate(migrants, members, fraction, clock, random);
    // The clock counts the births.
    EXPECT_NEAR(static_cast<double>(clock) / kRounds, expected, 5 * std::sqrt(expected / kRounds));
  }
}

TEST(PublishedBehaviour, ASignIsFlippedRarelyAndWithCompatNearlyAlways) {
  for (const bool compat : {false, true}) {
    MutationSettings settings;
    settings.compat = compat;
    RandomStream random = stream("flip");
    int flipped = 0;
    for (int i = 0; i < 100'000; ++i) {
      const double factor = constant_factor(settings, random);
      flipped += factor < 0 ? 1 : 0;
      EXPECT_LE(std::abs(factor), 1.229);
      EXPECT_GE(std::abs(factor), 1 / 1.2291);
    }
    const double expected = compat ? 1 - 0.00743 : 0.00743;
    EXPECT_NEAR(flipped / 1e5, expected, 0.0015);
  }
}

TEST(PublishedBehaviour, TheHallOfFameKeepsTheBestOfEachSizeAndTheFrontWhatIsStrictlyBetter) {
  HallOfFame hall(5);
  EXPECT_TRUE(hall.offer(member(3, 1, 0)));
  EXPECT_FALSE(hall.offer(member(3, 1, 1)));  // equal is not better
  EXPECT_TRUE(hall.offer(member(2, 1, 2)));
  EXPECT_TRUE(hall.offer(member(2, 3, 3)));
  EXPECT_TRUE(hall.offer(member(1, 4, 4)));
  EXPECT_FALSE(hall.offer(member(0, 6, 5)));  // too large
  const std::vector<Member> front = hall.front();
  ASSERT_EQ(front.size(), 2u);
  EXPECT_EQ(front[0].size, 1);
  EXPECT_EQ(front[1].size, 4);
  EXPECT_EQ(hall.members().size(), 3u);
}

TEST(PublishedBehaviour, SelectionFollowsTheRulesOnAHandMadeFront) {
  const std::vector<FrontPoint> front = {
      {10.0, 1, 60, 50}, {1.0, 3, 30, 20}, {0.9, 4, 14, 19}, {0.5, 6, 15, 15}, {0.45, 9, 22, 22}};
  const std::vector<double> scores = front_scores(front);
  EXPECT_DOUBLE_EQ(scores[0], 0);
  EXPECT_NEAR(scores[1], std::log(10.0) / 2, 1e-12);
  EXPECT_NEAR(scores[3], std::log(1.8) / 2, 1e-12);
  EXPECT_EQ(select(front, Selection::score), 1u);
  EXPECT_EQ(select(front, Selection::best), 3u);  // 0.5 and 0.45 are within 1.5 times the best
  EXPECT_EQ(select(front, Selection::accuracy), 4u);
  EXPECT_EQ(select(front, Selection::mdl), 3u);
  EXPECT_EQ(select(front, Selection::evidence), 2u);
}

TEST(PublishedBehaviour, TheProfilesHaveThePublishedDefaults) {
  const Options v1 = profile_options(Profile::v1);
  const Options v2 = profile_options(Profile::v2);
  EXPECT_EQ(v1.populations, 31);
  EXPECT_EQ(v1.population_size, 27);
  EXPECT_EQ(v1.cycles, 380);
  EXPECT_FALSE(v1.annealing);
  EXPECT_DOUBLE_EQ(v1.crossover_probability, 0.0259);
  EXPECT_TRUE(v2.annealing);
  EXPECT_DOUBLE_EQ(v2.crossover_probability, 0.2);
  EXPECT_EQ(v2.batching, Batching::automatic);
  EXPECT_EQ(v2.selection, Selection::best);
  EXPECT_DOUBLE_EQ(v1.weights[index_of(MutationKind::mutate_feature)], 0);
}

}  // namespace
}  // namespace tribench::pysr::published_behaviour_test
