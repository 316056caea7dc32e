// SPDX-License-Identifier: MIT
#include "algorithms/udsr/genetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "algorithms/udsr/policy.hpp"

namespace tribench::udsr {
namespace {

bool is_complete(const TokenLibrary& library, const Sequence& sequence) {
  Traversal traversal(library);
  for (const TokenId token : sequence) {
    if (traversal.complete()) return false;
    traversal.push(token);
  }
  return traversal.complete();
}

class GeneticTest : public testing::Test {
 protected:
  TokenLibrary library{find_operator_set("full"), 2, {.constants = true, .linear = true}};
  Prior prior{library, {}, {{-1, 2}, -5, 5}};
  std::vector<Sequence> sample =
      Policy(library, RandomStream(1)).sample(200, prior, RandomStream(2));
};

TEST_F(GeneticTest, CrossoverExchangesSubtreesAndKeepsTheRoots) {
  RandomStream random(3);
  for (std::size_t i = 0; i + 1 < sample.size(); ++i) {
    const auto [a, b] = crossover(library, sample[i], sample[i + 1], random);
    EXPECT_TRUE(is_complete(library, a));
    EXPECT_TRUE(is_complete(library, b));
    EXPECT_EQ(a.size() + b.size(), sample[i].size() + sample[i + 1].size());
    EXPECT_EQ(a[0], sample[i][0]);
    EXPECT_EQ(b[0], sample[i + 1][0]);
  }
}

TEST_F(GeneticTest, MutationMakesCompleteFormulasOfEverySize) {
  RandomStream random(4);
  int longer = 0;
  int shorter = 0;
  int same = 0;
  for (int k = 0; k < 2000; ++k) {
    const Sequence& parent = sample[random.below(sample.size())];
    const Sequence child = mutate(library, parent, {}, random);
    ASSERT_TRUE(is_complete(library, child));
    longer += child.size() > parent.size() ? 1 : 0;
    shorter += child.size() < parent.size() ? 1 : 0;
    same += child.size() == parent.size() ? 1 : 0;
  }
  EXPECT_GT(longer, 400);
  EXPECT_GT(shorter, 400);
  EXPECT_GT(same, 400);
}

TEST_F(GeneticTest, ElitesKeepTheConstraintsAreUniqueAndNoWorseThanTheSeed) {
  std::vector<double> x1, x2, y;
  RandomStream random(5);
  for (int i = 0; i < 60; ++i) {
    x1.push_back(random.uniform(-1, 2));
    x2.push_back(random.uniform(2, 3));
    y.push_back(std::sin(x1.back()) * x2.back() + x1.back() * x1.back());
  }
  const std::vector<Input> inputs = {{"x1", "-", Role::none, -1, 2, std::nullopt},
                                     {"x2", "-", Role::none, 2, 3, std::nullopt}};
  const std::vector<const double*> columns = {x1.data(), x2.data()};
  const ScoringProblem problem({inputs, columns, y, {}}, library, 3);
  Budget budget({});
  Scoreboard scoreboard(problem, budget, nullptr, 1);
  const std::vector<double> rewards = scoreboard.rewards(sample);
  const std::vector<Elite> elites =
      evolve(sample, rewards, prior, {}, library, RandomStream(6), scoreboard);
  ASSERT_FALSE(elites.empty());
  EXPECT_LE(elites.size(), 50U);
  EXPECT_GE(elites[0].reward, *std::ranges::max_element(rewards));
  std::vector<std::string> unique;
  for (const Elite& elite : elites) {
    EXPECT_TRUE(prior.allows(elite.sequence));
    unique.emplace_back(elite.sequence.begin(), elite.sequence.end());
  }
  std::ranges::sort(unique);
  EXPECT_EQ(std::ranges::adjacent_find(unique), unique.end());
}

}  // namespace
}  // namespace tribench::udsr
