// SPDX-License-Identifier: MIT
#include "algorithms/inference/whitening.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

TEST(Whitening, LeavesRowsOfOneVarianceThatKnowNothingOfTheirNeighboursNorOfTheirMovement) {
  const Clusters clusters = many_movements();
  Noise noise;
  noise.within_sd = 1;
  noise.between_sd = kBetween;
  noise.slow_share = 1;
  noise.slow_rho = kRho;
  noise.whitened = true;
  double squares = 0;
  double neighbours = 0;
  double sums = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd white = whitened(
        noise_of(RandomStream(2).split(static_cast<std::uint64_t>(run)), 1.0), clusters, noise);
    squares += white.squaredNorm();
    for (const RowRange& m : clusters.movements) {
      const auto part =
          white.segment(static_cast<Eigen::Index>(m.begin), static_cast<Eigen::Index>(m.size()));
      neighbours += part.head(part.size() - 1).dot(part.tail(part.size() - 1));
      sums += part.sum() * part.sum();
    }
  }
  constexpr double kAll = kRuns * kMovements * kRows;
  const double variance = squares / kAll;
  EXPECT_NEAR(variance, noise.row_variance(), 0.01 * variance);
  EXPECT_NEAR(neighbours / kAll, 0, 0.01 * variance);
  EXPECT_NEAR(sums / kAll, variance, 0.06 * variance);
  EXPECT_DOUBLE_EQ(noise.row_inflation(), 1);
}

// The first rows of a movement know nothing yet of the slow part: they are foretold as well as
// they can be, and no better.
TEST(Whitening, LeavesRowsOfOneVarianceWhereNoiseIsSlowUnderWhite) {
  Noise noise;
  noise.within_sd = 1;
  noise.slow_share = 0.6;
  noise.slow_rho = 0.9;
  noise.whitened = true;
  const Clusters clusters = make_clusters(movements_of({30}), 1);
  constexpr int kRuns = 20000;
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(30, 30);
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd white =
        whitened(slow_under_white(0.6, 0.9, 30, RandomStream(14).split(run)), clusters, noise);
    products += white * white.transpose() / kRuns;
  }
  const Eigen::MatrixXd expected = noise.row_variance() * Eigen::MatrixXd::Identity(30, 30);
  EXPECT_LT((products - expected).cwiseAbs().maxCoeff(), 0.05 * noise.row_variance());
}

// Of n independent rows with a common offset the covariance's determinant grows
// by 1 + n b^2/s^2.
TEST(OffsetNats, AreHalfTheLogOfWhatOffsetsAddToTheDeterminant) {
  const Clusters clusters = make_clusters(movements_of({20, 100}), 1);
  Noise noise;
  noise.within_sd = 2;
  noise.between_sd = 1.5;
  const Eigen::VectorXd nats = offset_nats(clusters, noise);
  ASSERT_EQ(nats.size(), 4);
  EXPECT_NEAR(nats[0], 0.5 * std::log(1 + 20 * 2.25 / 4), 1e-12);
  EXPECT_NEAR(nats.tail(3).sum(), 0.5 * std::log(1 + 100 * 2.25 / 4), 1e-12);
  EXPECT_DOUBLE_EQ(nats[1], nats[3]);
}

TEST(Whitening, CountsAMovementAsItsWeightSays) {
  Clusters clusters = make_clusters(movements_of({3, 3}), 1);
  clusters.weight = {1, 0.5};
  Noise noise;
  noise.within_sd = 1;
  const Eigen::MatrixXd rows = whitened(Eigen::MatrixXd::Ones(6, 1), clusters, noise);
  EXPECT_NEAR(rows(0, 0), 1, 1e-12);
  EXPECT_NEAR(rows(5, 0), 0.5, 1e-12);
}

}  // namespace
}  // namespace tribench::loop
