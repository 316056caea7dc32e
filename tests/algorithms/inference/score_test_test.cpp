// SPDX-License-Identifier: MIT
#include "algorithms/inference/score_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "algorithms/inference/cross_validation.hpp"

namespace tribench::loop::score_test_test {
namespace {

constexpr std::size_t kMovements = 60;
constexpr std::size_t kRows = 30;

struct Example {
  Clusters clusters;
  Eigen::MatrixXd x;           // an intercept and a slope
  Eigen::MatrixXd candidates;  // six columns, constant within movements
  Eigen::VectorXd y;
};

// Residuals that share an offset within each movement: tests that take rows for
// independent fail.
Example clustered_example(std::uint64_t seed, double planted) {
  RandomStream random(seed);
  Example e;
  std::vector<int> movement;
  const auto n = static_cast<Eigen::Index>(kMovements * kRows);
  e.x.resize(n, 2);
  e.candidates.resize(n, 6);
  e.y.resize(n);
  for (std::size_t m = 0; m < kMovements; ++m) {
    const double offset = random.normal();
    Eigen::RowVectorXd levels(6);
    for (double& level : levels) level = random.normal();
    for (std::size_t i = 0; i < kRows; ++i) {
      const auto row = static_cast<Eigen::Index>(m * kRows + i);
      movement.push_back(static_cast<int>(m));
      e.x.row(row) << 1, random.normal();
      e.candidates.row(row) = levels;
      e.y[row] = 2 + 0.5 * e.x(row, 1) + planted * levels[2] + offset + random.normal();
    }
  }
  e.clusters = make_clusters(movement, 1);
  return e;
}

// Smallest adjusted p over the candidates.
std::vector<double> adjusted_ps(const Example& e, const Flips& flips) {
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd residual = project_off(e.y, basis);
  std::vector<BlockScores> blocks;
  for (Eigen::Index j = 0; j < e.candidates.cols(); ++j) {
    blocks.push_back(score_block(e.candidates.col(j), basis, residual, e.clusters));
  }
  const std::vector<double> maxima = flip_maxima(blocks, flips);
  std::vector<double> ps;
  for (const BlockScores& block : blocks) ps.push_back(adjusted_p(block.test.score, maxima));
  return ps;
}

TEST(ScoreTest, RejectsTrueNullsAtTheNominalRateDespiteCorrelationWithinMovements) {
  constexpr int kRuns = 300;
  int rejected = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Flips flips(399, kMovements, RandomStream(1000 + run));
    const std::vector<double> ps = adjusted_ps(clustered_example(run, 0), flips);
    if (*std::min_element(ps.begin(), ps.end()) <= 0.05) ++rejected;
  }
  // 5 % of 300 are 15; three binomial standard errors are 11.
  EXPECT_LE(rejected, 26);
  EXPECT_GE(rejected, 4);
}

// p of one column, 30 times as large in two movements as in the others: as it stands, and with
// every stretch counting alike.
struct TwoLoudMovements {
  double as_it_stands;
  double evenly;
};

TwoLoudMovements two_loud_movements(std::uint64_t seed, double planted) {
  Example e = clustered_example(seed, 0);
  RandomStream random(seed + 50'000);
  Eigen::VectorXd column(e.y.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const double loud = i < 2 * static_cast<Eigen::Index>(kRows) ? 30 : 1;
    column[i] = loud * random.normal();
    e.y[i] = planted * column[i] + (loud > 1 ? 60 : 1) * random.normal();
  }
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd residual = project_off(e.y, basis);
  const Flips flips(399, kMovements, RandomStream(seed + 90'000));
  const auto p_of = [&](BlockScores block) {
    const double score = block.test.score;
    return adjusted_p(score, flip_maxima(std::span(&block, 1), flips));
  };
  return {p_of(score_block(column, basis, residual, e.clusters)),
          p_of(score_block_evenly(column, basis, residual, e.clusters))};
}

// The noise decides what the two say; the other 58 agree.
TEST(ScoreTest, WhatFewMovementsHoldMostOfIsToldByTheMany) {
  constexpr int kRuns = 40;
  int as_it_stands = 0;
  int evenly = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const TwoLoudMovements p = two_loud_movements(seed, 0.2);
    if (p.as_it_stands <= 0.005) ++as_it_stands;
    if (p.evenly <= 0.005) ++evenly;
  }
  EXPECT_LE(as_it_stands, kRuns / 2);
  EXPECT_GE(evenly, as_it_stands + kRuns / 5);
  EXPECT_GE(evenly, kRuns * 3 / 5);
}

TEST(ScoreTest, CountingAlikeKeepsTheLevel) {
  int rejected = 0;
  for (std::uint64_t run = 0; run < 300; ++run) {
    if (two_loud_movements(1000 + run, 0).evenly <= 0.05) ++rejected;
  }
  EXPECT_LE(rejected, 26);  // 15, and three binomial standard errors
  EXPECT_GE(rejected, 4);
}

TEST(ScoreTest, FindsAPlantedColumnAndNoOther) {
  const Flips flips(1999, kMovements, RandomStream(1));
  const std::vector<double> ps = adjusted_ps(clustered_example(7, 1.0), flips);
  EXPECT_LE(ps[2], 0.003);
  for (const std::size_t other : {0U, 1U, 3U, 4U, 5U}) EXPECT_GT(ps[other], 0.05) << other;
}

TEST(ScoreTest, AColumnInsideTheModelIsNotTestable) {
  const Example e = clustered_example(3, 0);
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd z = e.x * Eigen::Vector2d(3, -2);
  const BlockScores block = score_block(z, basis, project_off(e.y, basis), e.clusters);
  EXPECT_FALSE(block.test.testable);
  EXPECT_LT(block.test.share, 1e-6);
}

// A channel that never moved: nothing is said of it, and what is said of others stays.
TEST(ScoreTest, AColumnOfZerosIsNotTestableAndSpoilsNoOther) {
  const Example e = clustered_example(3, 0);
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd residual = project_off(e.y, basis);
  const Eigen::MatrixXd one = e.candidates.leftCols(1);
  const Eigen::MatrixXd zeros = Eigen::MatrixXd::Zero(e.x.rows(), 1);
  const BlockScores nothing = score_block(zeros, basis, residual, e.clusters);
  EXPECT_FALSE(nothing.test.testable);
  EXPECT_EQ(nothing.test.share, 0);
  EXPECT_EQ(score_statistic(zeros, basis, residual), 0);
  const BlockScores alone = score_block(one, basis, residual, e.clusters);
  const BlockScores both = score_block(beside(one, zeros), basis, residual, e.clusters);
  ASSERT_TRUE(alone.test.testable);
  EXPECT_NEAR(both.test.statistic, alone.test.statistic, 1e-9 * alone.test.statistic);
  EXPECT_NEAR(both.test.score, alone.test.score, 1e-9);
  EXPECT_NEAR(both.test.share, alone.test.share, 1e-9);
  EXPECT_NEAR(score_statistic(beside(one, zeros), basis, residual), alone.test.statistic,
              1e-9 * alone.test.statistic);
}

TEST(ScoreTest, TheStatisticAloneIsTheBlocks) {
  const Example e = clustered_example(5, 1);
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd residual = project_off(e.y, basis);
  const double whole = score_block(e.candidates, basis, residual, e.clusters).test.statistic;
  EXPECT_GT(whole, 1);
  EXPECT_NEAR(score_statistic(e.candidates, basis, residual), whole, 1e-9 * whole);
}

TEST(ScoreTest, DependentColumnsOfAModelAreLeftOutOfItsBasis) {
  Eigen::MatrixXd x = clustered_example(3, 0).x;
  x.conservativeResize(Eigen::NoChange, 3);
  x.col(2) = 2 * x.col(0) - x.col(1);
  EXPECT_EQ(orthonormal_basis(x).cols(), 2);
}

TEST(FlipMaxima, StopsOnceTheAnswerCannotBeSignificantAnyMore) {
  const Example e = clustered_example(5, 0);
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  std::vector<BlockScores> blocks = {
      score_block(e.candidates, basis, project_off(e.y, basis), e.clusters)};
  const Flips flips(1999, kMovements, RandomStream(2));
  EXPECT_LT(flip_maxima(blocks, flips, 0.0, 4).size(), 500U);
  EXPECT_EQ(flip_maxima(blocks, flips, 1e9, 4).size(), 1999U);  // which no flip reaches
  EXPECT_EQ(flip_maxima(blocks, flips).size(), 1999U);
}

TEST(HeldOutLosses, FavourTheColumnThatIsThereAndNotOneThatIsNot) {
  const Example e = clustered_example(11, 1.0);
  Noise noise;
  noise.within_sd = 1;
  const Eigen::VectorXd without = held_out_losses(e.x, e.y, e.clusters, noise);
  const Eigen::VectorXd right =
      held_out_losses(beside(e.x, e.candidates.col(2)), e.y, e.clusters, noise);
  const Eigen::VectorXd wrong =
      held_out_losses(beside(e.x, e.candidates.col(4)), e.y, e.clusters, noise);
  const Gain gain = paired_gain(without, right);
  EXPECT_GT(gain.nats, 3 * gain.error);
  EXPECT_LT(paired_gain(without, wrong).nats, 2 * paired_gain(without, wrong).error + 5);
}

TEST(AdjustedP, CountsTheObservedAmongTheFlips) {
  const std::vector<double> maxima = {1, 2, 3};
  EXPECT_EQ(adjusted_p(2, maxima), 0.75);
  EXPECT_EQ(adjusted_p(4, maxima), 0.25);
}

TEST(CriticalScore, IsTheOneThatSoManyFlipsReach) {
  std::vector<double> maxima(99);
  for (std::size_t i = 0; i < maxima.size(); ++i) maxima[i] = static_cast<double>(i * 37 % 99);
  EXPECT_EQ(critical_score(maxima, 0.05), 94);
  EXPECT_DOUBLE_EQ(adjusted_p(94.5, maxima), 0.05);  // of whatever is above it
  EXPECT_EQ(critical_score(maxima, 0.001), 98);
}

TEST(ScoreSums, OfOneColumnIsItsSquareOverItsOwn) {
  const double gram = 4;
  const Eigen::MatrixXd sums = Eigen::Vector3d(1, 3, -2);
  constexpr double kRidge = 0.25;
  const BlockScores block = score_sums(Eigen::MatrixXd::Constant(1, 1, gram), sums, kRidge);
  EXPECT_NEAR(block.test.statistic, 4 / (gram * (1 + kRidge)), 1e-6);
  // Over all signs: the mean is the sum of squares, the variance 4 sum over
  // pairs of their products.
  const double scale = gram * (1 + kRidge);
  const MatchedGamma gamma(14 / scale, 4 * (1 * 9 + 1 * 4 + 9 * 4) / (scale * scale));
  EXPECT_NEAR(block.test.score, gamma.score(4 / scale), 1e-6);
}

TEST(ScoreBlock, SaysHowManyClustersCarryIt) {
  std::vector<int> movement;
  for (int m = 0; m < 8; ++m) movement.insert(movement.end(), 10, m);
  const Clusters clusters = make_clusters(movement, 1);
  Eigen::MatrixXd column = Eigen::MatrixXd::Zero(80, 1);
  column.topRows(40).setOnes();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(80, 1);
  basis.bottomRows(40).setConstant(1 / std::sqrt(40.0));
  const BlockScores half = score_block(column, basis, column.col(0), clusters);
  EXPECT_NEAR(half.test.effective_clusters, 4, 1e-12);
  EXPECT_EQ(half.test.carrying, 4U);
  EXPECT_NEAR(half.test.share, 1, 1e-12);
  EXPECT_NEAR(half.test.information, 40, 1e-12);
  // Half of a column that the model has most of can be tested; a fortieth is as
  // good as nothing.
  const auto beside_model = [&](double times) {
    return score_block(column + std::sqrt(40 * (times * times - 1)) * basis, basis, column.col(0),
                       clusters);
  };
  EXPECT_NEAR(beside_model(2).test.share, 0.5, 1e-9);
  EXPECT_TRUE(beside_model(2).test.testable);
  EXPECT_FALSE(beside_model(40).test.testable);
}

// What a column shares with the model the model has said already.
TEST(ScoreTest, WhatTheModelExplainsIsNoPartOfABlock) {
  const Example e = clustered_example(4, 0.3);
  const Eigen::MatrixXd basis = orthonormal_basis(e.x);
  const Eigen::VectorXd residual = project_off(e.y, basis);
  Eigen::MatrixXd leaning = e.candidates.leftCols(3);
  leaning.col(0) += 2 * e.x.col(0);
  leaning.col(1) -= 3 * e.x.col(1);
  leaning.col(2) += e.x.rowwise().sum();
  const BlockTest upright = score_block(e.candidates.leftCols(3), basis, residual, e.clusters).test;
  const BlockTest leaned = score_block(leaning, basis, residual, e.clusters).test;
  EXPECT_NEAR(leaned.statistic, upright.statistic, 1e-8 * upright.statistic);
  EXPECT_NEAR(leaned.score, upright.score, 1e-6 * upright.score);
  EXPECT_NEAR(leaned.information, upright.information, 1e-8 * upright.information);
}

}  // namespace
}  // namespace tribench::loop::score_test_test
