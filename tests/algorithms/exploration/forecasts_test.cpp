// SPDX-License-Identifier: MIT
#include "algorithms/exploration/forecasts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

constexpr int kBatch = 20;

// Rows of a constant base and two columns, of which the first has a coefficient of `size` noises.
void add_batch(EvidenceSums& sums, double size, RandomStream& random) {
  Eigen::MatrixXd columns(kBatch, 2);
  Eigen::VectorXd target(kBatch);
  for (int i = 0; i < kBatch; ++i) {
    for (int j = 0; j < 2; ++j) columns(i, j) = random.normal();
    target[i] = 3 + 0.2 * (size * columns(i, 0) + random.normal());
  }
  sums.add(Eigen::MatrixXd::Ones(kBatch, 1), columns, target);
}

const std::array<EffectBlock, 2> kBlocks = {EffectBlock{{0}}, EffectBlock{{1}}};

Explanation explanation(const std::vector<std::size_t>& families, double prior) {
  Explanation one;
  one.families = families;
  for (const std::size_t f : families) {
    one.blocks.push_back(&kBlocks[f]);
    one.verdict += f == 0 ? "first" : "second";
  }
  if (families.empty()) one.verdict = "NONE";
  one.log_prior = std::log(prior);
  return one;
}

std::vector<Explanation> all_explanations() {
  return {explanation({}, 0.4), explanation({0}, 0.25), explanation({1}, 0.25),
          explanation({0, 1}, 0.1)};
}

double log_e_value(const std::vector<ForecastVerdict>& verdicts, const std::string& verdict) {
  return std::ranges::find(verdicts, verdict, &ForecastVerdict::verdict)->log_e_value;
}

TEST(Forecasts, TellWhatForesawTheRows) {
  RandomStream random(5);
  EvidenceSums sums;
  add_batch(sums, 0.8, random);
  Forecasts forecasts;
  EXPECT_TRUE(forecasts.verdicts().empty());
  for (int k = 0; k < 20; ++k) {
    const EvidenceTable before(sums);
    add_batch(sums, 0.8, random);
    forecasts.hear(all_explanations());
    forecasts.add(all_explanations(), before, EvidenceTable(sums));
  }
  const std::vector<ForecastVerdict> verdicts = forecasts.verdicts();
  EXPECT_EQ(verdicts.front().verdict, "first");
  EXPECT_GT(verdicts.front().log_e_value, std::log(100));
  EXPECT_LT(log_e_value(verdicts, "NONE"), -std::log(100));
  double sum = 0;
  for (const ForecastVerdict& one : verdicts) sum += one.weight;
  EXPECT_NEAR(sum, 1, 1e-9);
}

// Ville: whenever one stops, what is wrong has a large e-value in a share of alpha at most.
TEST(Forecasts, RarelyFavourWhatIsWrongHoweverOftenOneLooks) {
  constexpr double kAlpha = 0.05;
  constexpr int kRuns = 200;
  int wrong = 0;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(100 + static_cast<std::uint64_t>(run));
    EvidenceSums sums;
    add_batch(sums, 0, random);
    Forecasts forecasts;
    bool ever = false;
    for (int k = 0; k < 30; ++k) {
      const EvidenceTable before(sums);
      add_batch(sums, 0, random);
      forecasts.hear(all_explanations());
      forecasts.add(all_explanations(), before, EvidenceTable(sums));
      for (const ForecastVerdict& one : forecasts.verdicts()) {
        ever = ever || (one.verdict != "NONE" && one.log_e_value > -std::log(kAlpha));
      }
    }
    wrong += ever ? 1 : 0;
  }
  EXPECT_LE(wrong, kAlpha * kRuns);
}

// Its share of the prior, as if it had said until then what all others said.
TEST(Forecasts, WhatComesLateEntersWithItsPrior) {
  RandomStream random(7);
  EvidenceSums sums;
  add_batch(sums, 0, random);
  Forecasts forecasts;
  const std::vector<Explanation> all = all_explanations();
  const std::vector<Explanation> few(all.begin(), all.begin() + 2);
  for (int k = 0; k < 5; ++k) {
    const EvidenceTable before(sums);
    add_batch(sums, 0, random);
    forecasts.hear(few);
    forecasts.add(few, before, EvidenceTable(sums));
  }
  EXPECT_EQ(forecasts.verdicts().size(), 2U);
  const EvidenceTable now(sums);
  forecasts.hear(all);
  forecasts.add(all, now, now);  // no further row
  const std::vector<ForecastVerdict> verdicts = forecasts.verdicts();
  ASSERT_EQ(verdicts.size(), 4U);
  EXPECT_NEAR(log_e_value(verdicts, "second"), 0, 1e-9);
  EXPECT_NEAR(log_e_value(verdicts, "firstsecond"), 0, 1e-9);
}

// What the rows so far made of them, before anything was foreseen: its Bayes factor.
TEST(Forecasts, OpenWithTheBayesFactorOfTheRowsSoFar) {
  RandomStream random(9);
  EvidenceSums sums;
  for (int k = 0; k < 5; ++k) add_batch(sums, 0.8, random);
  const EvidenceTable now(sums);
  std::vector<Explanation> all = all_explanations();
  double others = 0;  // the mixture of all but the first
  double prior = 0;
  for (Explanation& one : all) {
    one.log_evidence = now.log_factor(one.blocks);
    if (one.verdict == "first") continue;
    others += std::exp(one.log_prior + one.log_evidence);
    prior += std::exp(one.log_prior);
  }
  Forecasts forecasts;
  forecasts.hear(all);
  const std::vector<ForecastVerdict> verdicts = forecasts.verdicts();
  EXPECT_NEAR(log_e_value(verdicts, "first"), all[1].log_evidence - std::log(others / prior), 1e-9);
  forecasts.hear(all);  // known already
  EXPECT_EQ(log_e_value(forecasts.verdicts(), "first"), log_e_value(verdicts, "first"));
}

}  // namespace
}  // namespace tribench::loop
