// SPDX-License-Identifier: MIT
#include "algorithms/inference/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

TEST(MovementWeights, AreOneWhereAllAreAlikeAndFollowTheNoiseWhereTheyDiffer) {
  const Clusters clusters = many_movements();
  for (const double weight : movement_weights(noise_of(RandomStream(3), 1.0), clusters)) {
    EXPECT_NEAR(weight, 1, 0.15);
  }
  const std::vector<double> weights = movement_weights(noise_of(RandomStream(4), 3.0), clusters);
  double quiet = 0;
  double loud = 0;
  for (std::size_t m = 0; m < kMovements; ++m) (m % 2 == 1 ? loud : quiet) += weights[m];
  EXPECT_NEAR(quiet / loud, 3, 0.6);
}

TEST(EstimateNoise, FindsWhatTheRowsWereMadeWith) {
  const Clusters clusters = make_clusters(movements_of({4000, 4000, 4000, 4000, 4000, 4000}), 1);
  RandomStream random(5);
  Eigen::VectorXd residual(24000);
  const double offsets[] = {1, -1, 2, -2, 1, -1};  // rms sqrt(2)
  double x = random.normal();
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    x = kRho * x + std::sqrt(1 - kRho * kRho) * random.normal();
    residual[i] = offsets[i / 4000] + 0.5 * x;
  }
  const Noise noise = estimate_noise(residual, clusters, 0, 0);
  EXPECT_NEAR(noise.within_sd, 0.5, 0.01);
  EXPECT_NEAR(noise.rho(), kRho, 0.02);
  EXPECT_NEAR(noise.between_sd, std::sqrt(2.0), 0.03);
  EXPECT_EQ(noise.slow_share, 1);
  EXPECT_DOUBLE_EQ(noise.inflation(), (1 + noise.rho()) / (1 - noise.rho()));
  EXPECT_NEAR(noise.effective_rows, 24000 / noise.inflation(), 1e-6);
  // Each fitted parameter costs a degree of freedom, each movement's mean one
  // already.
  EXPECT_NEAR(estimate_noise(residual, clusters, 12000, 0).within_sd / noise.within_sd,
              std::sqrt((24000.0 - 6) / (24000 - 6 - 12000)), 1e-12);
}

// As loud as its weight says, a movement tells the same as one of the usual
// noise, the first and the last of them too.
TEST(EstimateNoise, CountsEachMovementByItsWeight) {
  Clusters clusters = make_clusters(movements_of({40, 40, 40, 40}), 1);
  RandomStream random(6);
  Eigen::VectorXd residual(160);
  for (double& x : residual) x = random.normal();
  const Noise alike = estimate_noise(residual, clusters, 0, 0);
  clusters.weight = {0.25, 1, 2, 0.1};
  for (Eigen::Index i = 0; i < 160; ++i) {
    residual[i] /= clusters.weight[static_cast<std::size_t>(i / 40)];
  }
  const Noise weighted = estimate_noise(residual, clusters, 0, 0);
  EXPECT_NEAR(weighted.within_sd, alike.within_sd, 1e-12);
  EXPECT_NEAR(weighted.rho(), alike.rho(), 1e-12);
}

// N m or kN m: what is correlated stays so.
TEST(EstimateNoise, SaysTheSameInAnyUnit) {
  const Clusters clusters = many_movements();
  const Eigen::VectorXd residual = noise_of(RandomStream(11), 1);
  const Noise whole = estimate_noise(residual, clusters, 3, 0);
  const Noise scaled = estimate_noise(1e-6 * residual, clusters, 3, 0);
  ASSERT_GT(whole.rho(), 0);
  EXPECT_NEAR(scaled.rho(), whole.rho(), 1e-12);
  EXPECT_NEAR(scaled.within_sd, 1e-6 * whole.within_sd, 1e-18);
  EXPECT_NEAR(scaled.between_sd, 1e-6 * whole.between_sd, 1e-18);
}

// The noise within movements moves their means too: that is no offset.
TEST(EstimateNoise, OffsetsAreWhatMeansDifferByBeyondTheNoise) {
  const Clusters clusters = many_movements();
  constexpr int kRuns = 40;
  double variance = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Noise noise = estimate_noise(noise_of(RandomStream(9).split(run), 1), clusters, 0, 0);
    variance += noise.between_sd * noise.between_sd / kRuns;
  }
  EXPECT_NEAR(variance, kBetween * kBetween, 0.025);  // the means' own is 0.08
}

TEST(EstimateNoise, OfAPerfectFitIsTheFloor) {
  const Clusters clusters = make_clusters(movements_of({10, 10, 10}), 1);
  const Noise noise = estimate_noise(Eigen::VectorXd::Zero(30), clusters, 2, 0.25);
  EXPECT_EQ(noise.within_sd, 0.25);
  EXPECT_EQ(noise.rho(), 0);
  EXPECT_EQ(noise.between_sd, 0);
  EXPECT_EQ(noise.effective_rows, 30);
}

// A drift that hardly moves from row to row: one row in a thousand counts, not none.
TEST(EstimateNoise, LeavesSomethingToLearnFromHoweverSmoothItIs) {
  constexpr Eigen::Index kMany = 6000;
  const Eigen::VectorXd drift = Eigen::VectorXd::NullaryExpr(
      kMany, [](Eigen::Index i) { return std::sin(6.283185307 * static_cast<double>(i) / kMany); });
  const Clusters clusters = make_clusters(movements_of({kMany}), 1);
  const Noise noise = estimate_noise(drift, clusters, 0, 0);
  EXPECT_NEAR(noise.slow_rho, 0.998, 1e-12);
  EXPECT_NEAR(noise.inflation(), 999, 1e-6);
}

// As many parameters as rows, or more: the noise is what is left, with one degree of freedom.
TEST(EstimateNoise, KeepsOneDegreeOfFreedomWhereTheModelHasThemAll) {
  const Clusters clusters = make_clusters(movements_of({2, 2, 2}), 1);
  Eigen::VectorXd residual(6);
  residual << 1, -1, 1, -1, 1, -1;
  EXPECT_DOUBLE_EQ(estimate_noise(residual, clusters, 2, 0).within_sd, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(estimate_noise(residual, clusters, 20, 0).within_sd, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(estimate_noise(residual, clusters, 1, 0).within_sd, std::sqrt(3.0));
}

TEST(EstimateNoise, TwoMovementsSayNothingOfOffsets) {
  Eigen::VectorXd residual(40);
  for (Eigen::Index i = 0; i < 40; ++i) residual[i] = (i < 20 ? 5 : -5) + (i % 2 == 0 ? 1 : -1);
  EXPECT_EQ(estimate_noise(residual, make_clusters(movements_of({20, 20}), 1), 0, 0).between_sd, 0);
  // Three do: the mean square of theirs (5, -5 and 0) less what the noise within makes of it.
  residual.conservativeResize(60);
  for (Eigen::Index i = 40; i < 60; ++i) residual[i] = i % 2 == 0 ? 1 : -1;
  const Noise noise = estimate_noise(residual, make_clusters(movements_of({20, 20, 20}), 1), 0, 0);
  const double within = 60.0 / 57;
  EXPECT_NEAR(noise.between_sd, std::sqrt((50 - 3 * within / 20) / 3), 1e-12);
}

// Every second row of slow noise under white one is such noise too, half as long in rows.
TEST(EstimateNoise, TellsASlowPartFromAWhiteOneAtAnyRateOfRows) {
  constexpr Eigen::Index kAll = 60000;
  const Eigen::VectorXd rows = slow_under_white(0.5, 0.95, kAll, RandomStream(12));
  for (const Eigen::Index step : {1, 2, 4}) {
    const Eigen::Index count = kAll / step;
    const Eigen::VectorXd some = rows(Eigen::seqN(0, count, step));
    const Noise noise =
        estimate_noise(some, make_clusters(movements_of({static_cast<int>(count)}), 1), 0, 0);
    const double rho = std::pow(0.95, static_cast<double>(step));
    EXPECT_NEAR(noise.slow_share, 0.5, 0.04) << step;
    EXPECT_NEAR(noise.slow_rho, rho, 0.02) << step;
    EXPECT_NEAR(noise.inflation() * static_cast<double>(step), 20, 3) << step;
  }
}

// White noise, an autoregression: neither gets a part that it has not.
TEST(EstimateNoise, AWhitePartIsWorthAParameterOrThereIsNone) {
  const Clusters clusters = make_clusters(movements_of({3000}), 1);
  for (std::uint64_t run = 0; run < 40; ++run) {
    const RandomStream random = RandomStream(13).split(run);
    const Noise slow = estimate_noise(slow_under_white(1, kRho, 3000, random), clusters, 0, 0);
    EXPECT_NEAR(slow.inflation(), 4, 0.9) << run;
    const Noise white = estimate_noise(slow_under_white(0, 0, 3000, random), clusters, 0, 0);
    EXPECT_NEAR(white.inflation(), 1, 0.25) << run;
  }
}

// One movement twenty times as loud as the others, each of 30 rows.
std::vector<double> weights_with_a_loud_movement(std::size_t movements) {
  RandomStream random(8);
  std::vector<int> movement;
  Eigen::VectorXd residual(static_cast<Eigen::Index>(30 * movements));
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    residual[i] = (i < 30 ? 20 : 1) * random.normal();
    movement.push_back(static_cast<int>(i / 30));
  }
  return movement_weights(residual, make_clusters(movement, 1));
}

TEST(MovementWeights, AreNotTriedWithFewMovements) {
  for (const double weight : weights_with_a_loud_movement(9)) EXPECT_EQ(weight, 1);
  const std::vector<double> ten = weights_with_a_loud_movement(10);
  EXPECT_GT(ten[1] / ten[0], 5);
}

// What sampling alone makes the logarithms of variances differ by (the kurtosis and the correlation
// of the rows say how much) is shrunk away; the mean square is 1.
TEST(MovementWeights, KeepWhatSamplingDoesNotExplain) {
  constexpr std::size_t kCount = 14;
  RandomStream random(12);
  std::vector<int> movement;
  std::vector<double> values;
  for (std::size_t m = 0; m < kCount; ++m) {
    const std::size_t rows = m == 5 ? 2 : 15 + 5 * (m % 5);
    for (std::size_t i = 0; i < rows; ++i) {
      const double before = i == 0 ? 0 : values.back();
      values.push_back(0.4 * before + (1 + 0.3 * static_cast<double>(m % 4)) * random.normal());
      movement.push_back(static_cast<int>(m));
    }
  }
  const auto count = static_cast<Eigen::Index>(values.size());
  const Eigen::VectorXd residual = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
  const Clusters clusters = make_clusters(movement, 1);
  const Noise noise = estimate_noise(residual, clusters, 0, 0);
  const double variance = noise.within_sd * noise.within_sd;
  const double squares = noise.rho() * noise.rho() / (1 - noise.slow_rho * noise.slow_rho);
  Eigen::ArrayXd logs(kCount);
  double fourth = 0;
  double each = 0;  // mean of 1 / rows
  for (std::size_t m = 0; m < kCount; ++m) {
    const RowRange& range = clusters.movements[m];
    const auto rows = static_cast<Eigen::Index>(range.size());
    const Eigen::ArrayXd own =
        residual.segment(static_cast<Eigen::Index>(range.begin), rows).array();
    const Eigen::ArrayXd deviation = own - own.mean();
    logs[static_cast<Eigen::Index>(m)] =
        std::log(deviation.square().sum() / static_cast<double>(rows - 1) / variance);
    fourth += deviation.pow(4).sum() / static_cast<double>(count);
    each += 1 / static_cast<double>(rows) / kCount;
  }
  const double kurtosis = fourth / (variance * variance);
  const double sampling = (kurtosis - 1) * (1 + 2 * squares) * each;
  const Eigen::ArrayXd apart = logs - logs.mean();
  const double kept = 1 - sampling / (apart.square().sum() / (kCount - 1));
  ASSERT_GT(kept, 0.1);
  ASSERT_LT(kept, 0.9);
  Eigen::ArrayXd expected = (-0.5 * kept * apart).exp();
  expected /= std::sqrt(expected.square().mean());
  const std::vector<double> weights = movement_weights(residual, clusters);
  for (std::size_t m = 0; m < kCount; ++m) {
    EXPECT_NEAR(weights[m], expected[static_cast<Eigen::Index>(m)], 1e-9);
  }
}

// A movement in which the drive stood still has no noise of its own: it may not outweigh all
// others.
TEST(MovementWeights, OfAMovementWithoutNoiseAreFinite) {
  RandomStream random(13);
  std::vector<int> movement;
  Eigen::VectorXd residual(300);
  for (Eigen::Index i = 0; i < 300; ++i) {
    residual[i] = i < 30 ? 0.5 : random.normal();
    movement.push_back(static_cast<int>(i / 30));
  }
  const std::vector<double> weights = movement_weights(residual, make_clusters(movement, 1));
  EXPECT_GT(weights[0], weights[1]);
  EXPECT_LE(weights[0] / weights[1], 1500);  // a variance of a millionth is the least
  for (const double one :
       movement_weights(Eigen::VectorXd::Zero(300), make_clusters(movement, 1))) {
    EXPECT_EQ(one, 1);
  }
}

TEST(CorrelationTime, FollowsTheCorrelationOfNeighbours) {
  const std::vector<RowRange> one = {{0, 60000}};
  for (const double rho : {0.0, 0.6, 0.9}) {
    RandomStream random(6);
    Eigen::VectorXd rows(60000);
    double x = random.normal();
    for (double& row : rows) row = x = rho * x + random.normal();
    // The sum of rho^k down to 0.05 is below the decay's -1 / log(rho).
    const double expected = rho == 0 ? 1 : -1 / std::log(rho);
    EXPECT_NEAR(correlation_time(rows, one), expected, 0.06 * expected) << rho;
  }
  EXPECT_EQ(correlation_time(Eigen::VectorXd::Ones(100), std::vector<RowRange>{{0, 100}}), 1);
}

// However smooth: neighbours are taken to agree by 0.998 at most.
TEST(CorrelationTime, OfADriftIsFiniteAndKnown) {
  const Eigen::VectorXd drift = Eigen::VectorXd::NullaryExpr(
      300, [](Eigen::Index i) { return std::sin(6.283185307 * static_cast<double>(i) / 300); });
  EXPECT_NEAR(correlation_time(drift, std::vector<RowRange>{{0, 300}}), -1 / std::log(0.998), 1e-9);
}

TEST(CorrelationTime, SaysTheSameInAnyUnit) {
  const std::vector<RowRange> one = {{0, 2000}};
  RandomStream random(14);
  Eigen::VectorXd rows(2000);
  double x = 0;
  for (double& row : rows) row = x = 0.8 * x + random.normal();
  const double whole = correlation_time(rows, one);
  ASSERT_GT(whole, 2);
  EXPECT_NEAR(correlation_time(1e-6 * rows, one), whole, 1e-9);
}

// Over all lags that two rows of a movement have, up to the first that has faded.
TEST(CorrelationTime, IsThatOfItsDefinition) {
  const std::vector<RowRange> movements = {{0, 7}, {7, 50}, {50, 120}};
  for (std::uint64_t run = 0; run < 20; ++run) {
    Eigen::VectorXd rows = slow_under_white(0.5 + 0.02 * static_cast<double>(run), 0.95, 120,
                                            RandomStream(15).split(run));
    const double whole = correlation_time(rows, movements);
    for (const RowRange& m : movements) {
      auto part =
          rows.segment(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()));
      part.array() -= part.mean();
    }
    double sum = 0;
    double first = 0;
    for (std::size_t lag = 1; lag < 70; ++lag) {
      double rho = 0;
      for (const RowRange& m : movements) {
        for (std::size_t i = m.begin + lag; i < m.end; ++i) {
          rho += rows[static_cast<Eigen::Index>(i)] * rows[static_cast<Eigen::Index>(i - lag)];
        }
      }
      rho /= rows.squaredNorm();
      if (lag == 1) first = rho;
      if (rho < 0.05) break;
      sum += rho;
    }
    ASSERT_GT(first, 0);
    EXPECT_NEAR(whole, std::max({1.0, -1 / std::log(first), sum}), 1e-9) << run;
  }
}

// Correlation that lasts longer than neighbours show is in the sum: a slow wave
// under white noise.
TEST(CorrelationTime, SeesAWaveUnderNoise) {
  RandomStream random(7);
  Eigen::VectorXd rows(20000);
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    rows[i] = std::sin(0.02 * static_cast<double>(i)) + random.normal();
  }
  // 1/3 cos(0.02 k) falls below 0.05 at k = 71; the sum up to there is 16.
  EXPECT_NEAR(correlation_time(rows, std::vector<RowRange>{{0, 20000}}), 16, 2);
}

}  // namespace
}  // namespace tribench::loop
