// SPDX-License-Identifier: MIT
#include "algorithms/udsr/policy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/udsr/training.hpp"

namespace tribench::udsr::policy_test {
namespace {

// Every weight away from zero, so that no part of a gradient vanishes by symmetry.
struct Fixture {
  TokenLibrary library{find_operator_set("paper+div"), 2, {.constants = true, .linear = true}};
  Prior prior{library, {}, {{1, 1}, -1, 1}};
  Policy policy{library, RandomStream(5)};

  Fixture() {
    RandomStream random(6);
    for (double& p : policy.parameters()) p = 0.4 * random.normal();
  }
};

TEST(Policy, GradientAgreesWithFiniteDifferences) {
  Fixture f;
  const std::vector<Sequence> sequences = f.policy.sample(6, f.prior, RandomStream(7));
  std::vector<WeightedSequence> batch;
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    const auto k = static_cast<double>(i);
    batch.push_back({&sequences[i], 0.3 - 0.2 * k, 0.05 * (1 + k)});
  }
  Eigen::VectorXd gradient;
  f.policy.loss(batch, f.prior, 0.7, gradient);
  RandomStream pick(8);
  Eigen::VectorXd unused;
  for (int k = 0; k < 300; ++k) {
    const auto i =
        static_cast<Eigen::Index>(pick.below(static_cast<std::uint64_t>(gradient.size())));
    constexpr double kStep = 1e-5;
    double& parameter = f.policy.parameters()[i];
    const double value = parameter;
    parameter = value + kStep;
    const double up = f.policy.loss(batch, f.prior, 0.7, unused);
    parameter = value - kStep;
    const double down = f.policy.loss(batch, f.prior, 0.7, unused);
    parameter = value;
    EXPECT_NEAR(gradient[i], (up - down) / (2 * kStep), 1e-6 * (1 + std::abs(gradient[i]))) << i;
  }
}

TEST(Policy, SamplesOnlyWhatThePriorAllowsAndEachSequenceFromItsOwnStream) {
  const Fixture f;
  const std::vector<Sequence> sequences = f.policy.sample(500, f.prior, RandomStream(9));
  for (const Sequence& sequence : sequences) EXPECT_TRUE(f.prior.allows(sequence));
  const std::vector<Sequence> fewer = f.policy.sample(20, f.prior, RandomStream(9));
  for (std::size_t i = 0; i < fewer.size(); ++i) EXPECT_EQ(fewer[i], sequences[i]);
}

TEST(Policy, ProbabilitiesOfAllShortFormulasSumToOne) {
  const TokenLibrary library(find_operator_set("paper"), 1, {.constants = false, .linear = false});
  PriorOptions options;
  options.min_length = 1;
  options.max_length = 5;
  const Prior prior(library, options, {{1}, 1, 2});
  Policy policy(library, RandomStream(1));
  RandomStream random(2);
  for (double& p : policy.parameters()) p = 0.5 * random.normal();
  std::vector<Sequence> all;
  std::vector<Sequence> open = {{}};
  while (!open.empty()) {
    const Sequence start = open.back();
    open.pop_back();
    for (std::size_t t = 0; t < library.size(); ++t) {
      Sequence longer = start;
      longer.push_back(static_cast<TokenId>(t));
      if (prior.allows(longer)) all.push_back(longer);
      if (longer.size() < 5) open.push_back(longer);
    }
  }
  std::vector<const Sequence*> pointers;
  for (const Sequence& sequence : all) pointers.push_back(&sequence);
  double total = 0;
  for (const double log_p : policy.log_probabilities(pointers, prior)) total += std::exp(log_p);
  EXPECT_GT(all.size(), 20U);
  EXPECT_NEAR(total, 1.0, 1e-9);
}

TEST(Policy, LearnsTheSequenceThatIsRewarded) {
  Fixture f;
  const Sequence target = f.policy.sample(1, f.prior, RandomStream(10))[0];
  Adam adam(f.policy.parameters().size(), 0.01);
  const std::vector<WeightedSequence> batch = {{&target, 1.0, 0.0}};
  Eigen::VectorXd gradient;
  for (int step = 0; step < 300; ++step) {
    f.policy.loss(batch, f.prior, 1.0, gradient);
    adam.step(gradient, f.policy.parameters());
  }
  const Sequence* pointer = &target;
  EXPECT_GT(std::exp(f.policy.log_probabilities({&pointer, 1}, f.prior)[0]), 0.9);
}

TEST(RewardQuantile, TakesTheHigherOfTwoNeighbours) {
  EXPECT_EQ(reward_quantile({0, 1, 2, 3, 4}, 0.25), 3);
  EXPECT_EQ(reward_quantile({4, 0, 2, 1, 3}, 0.2), 4);  // place 3.2 of 0..4
  EXPECT_EQ(reward_quantile({}, 0.05), 0);
}

}  // namespace
}  // namespace tribench::udsr::policy_test
