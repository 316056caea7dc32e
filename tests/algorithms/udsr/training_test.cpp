// SPDX-License-Identifier: MIT
#include "algorithms/udsr/training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/algorithms/udsr/tokens.hpp"

namespace tribench::udsr {
namespace {

// sin(x) + x^2 on 40 points; the policy starts untrained and has no genetic programming to help.
class TrainingTest : public testing::Test {
 protected:
  TrainingTest() {
    RandomStream random(5);
    for (int i = 0; i < 40; ++i) {
      x.push_back(random.uniform(-1, 2));
      y.push_back(std::sin(x.back()) + x.back() * x.back());
    }
    columns = {x.data()};
  }

  // Mean reward of fresh samples after `steps` steps of training.
  double mean_reward_after(int steps, TrainingOptions options) {
    options.max_steps = steps;
    options.patience = 1000;
    options.batch = 150;
    options.learning_rate = 0.01;
    options.entropy_weight = 0.005;
    options.genetic = false;
    options.success_nmse = 0;
    Policy policy(library, RandomStream(6));
    Budget budget({});
    Scoreboard scoreboard(problem(), budget, nullptr, 1);
    train(policy, prior, options, RandomStream(7), scoreboard);
    const std::vector<Sequence> fresh = policy.sample(400, prior, RandomStream(8));
    double mean = 0;
    for (const double reward : scoreboard.rewards(fresh)) mean += reward / 400;
    return mean;
  }

  const ScoringProblem& problem() {
    if (!problem_) problem_.emplace(TrainingData{inputs, columns, y, {}}, library, 3);
    return *problem_;
  }

  TokenLibrary library{find_operator_set("koza"), 1, {.constants = false, .linear = false}};
  Prior prior{library, {}, {{-1}, -1, 5}};
  std::vector<Input> inputs = {{"x", "-", Role::none, -1, 2, std::nullopt}};
  std::vector<double> x, y;
  std::vector<const double*> columns;
  std::optional<ScoringProblem> problem_;
};

TEST_F(TrainingTest, EveryUpdateTeachesThePolicyToWriteBetterFormulas) {
  const double untrained = mean_reward_after(0, {});
  for (const PolicyUpdate update :
       {PolicyUpdate::risk_seeking, PolicyUpdate::priority_queue, PolicyUpdate::ppo}) {
    TrainingOptions options;
    options.update = update;
    EXPECT_GT(mean_reward_after(20, options), 1.2 * untrained) << static_cast<int>(update);
  }
  TrainingOptions none;
  none.update = PolicyUpdate::none;
  EXPECT_EQ(mean_reward_after(5, none), untrained);
}

// Baselines at a mean push half of what is kept away: at this learning rate they only have to
// differ.
TEST_F(TrainingTest, QuantileBaselinesTeachAndEveryBaselineHasAnEffect) {
  const double untrained = mean_reward_after(0, {});
  std::vector<double> rewards;
  for (const Baseline baseline :
       {Baseline::quantile, Baseline::moving_quantile, Baseline::moving_mean, Baseline::combined}) {
    TrainingOptions options;
    options.baseline = baseline;
    rewards.push_back(mean_reward_after(20, options));
  }
  EXPECT_GT(rewards[0], 1.2 * untrained);
  EXPECT_GT(rewards[1], 1.2 * untrained);
  std::ranges::sort(rewards);
  EXPECT_EQ(std::ranges::adjacent_find(rewards), rewards.end());
}

TEST_F(TrainingTest, StopsWithinItsBudget) {
  Policy policy(library, RandomStream(6));
  constexpr std::uint64_t kLimit = 300'000;
  Budget budget({kLimit, INFINITY});
  Scoreboard scoreboard(problem(), budget, nullptr, 1);
  TrainingOptions options;
  options.success_nmse = 0;
  options.patience = 100000;
  options.max_steps = 100000;
  train(policy, prior, options, RandomStream(7), scoreboard);
  EXPECT_LE(budget.spent(), kLimit);
  EXPECT_GT(budget.spent(), kLimit * 9 / 10);
}

}  // namespace
}  // namespace tribench::udsr
