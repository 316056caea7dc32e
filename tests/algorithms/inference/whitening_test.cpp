// SPDX-License-Identifier: MIT
#include "algorithms/inference/whitening.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
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

// The covariance of a movement's rows: the noise's two parts, and its offset.
Eigen::MatrixXd covariance_of(const Noise& noise, double weight, Eigen::Index rows) {
  Eigen::MatrixXd out(rows, rows);
  const double variance = noise.within_sd * noise.within_sd / (weight * weight);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < rows; ++j) {
      const double white = i == j ? 1 - noise.slow_share : 0;
      const double slow = noise.slow_share * std::pow(noise.slow_rho, std::abs(i - j));
      out(i, j) = variance * (white + slow) + noise.between_sd * noise.between_sd;
    }
  }
  return out;
}

// Rows come out uncorrelated and of one variance, the first ones of a movement too, whatever part
// of the noise is slow, however long a movement is and whatever it weighs.
TEST(Whitening, MakesOfItsOwnNoiseRowsOfOneVariance) {
  Clusters clusters = make_clusters(movements_of({1, 2, 3, 40}), 1);
  clusters.weight = {1, 2, 0.5, 1.5};
  for (const double share : {1.0, 0.6, 0.05}) {
    for (const double between : {0.0, 0.7}) {
      Noise noise;
      noise.within_sd = 1.3;
      noise.between_sd = between;
      noise.slow_share = share;
      noise.slow_rho = 0.9;
      noise.whitened = true;
      const Eigen::MatrixXd filter = whitened(Eigen::MatrixXd::Identity(46, 46), clusters, noise);
      Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(46, 46);
      for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
        const auto begin = static_cast<Eigen::Index>(clusters.movements[m].begin);
        const auto rows = static_cast<Eigen::Index>(clusters.movements[m].size());
        covariance.block(begin, begin, rows, rows) = covariance_of(noise, clusters.weight[m], rows);
      }
      const Eigen::MatrixXd out = filter * covariance * filter.transpose();
      const Eigen::MatrixXd expected = noise.row_variance() * Eigen::MatrixXd::Identity(46, 46);
      EXPECT_LT((out - expected).cwiseAbs().maxCoeff(), 1e-9) << share << ' ' << between;
    }
  }
}

// A score can be had from the whitened column, or from the column as it was.
TEST(Whitening, HasAnAdjoint) {
  Clusters clusters = make_clusters(movements_of({1, 2, 3, 40}), 1);
  clusters.weight = {1, 2, 0.5, 1.5};
  Noise noise;
  noise.within_sd = 1.3;
  noise.between_sd = 0.7;
  noise.slow_share = 0.6;
  noise.slow_rho = 0.9;
  for (const bool whitens : {false, true}) {
    noise.whitened = whitens;
    const Eigen::MatrixXd filter = whitened(Eigen::MatrixXd::Identity(46, 46), clusters, noise);
    const Whitening whitening(clusters, noise);
    for (Eigen::Index row = 0; row < 46; ++row) {
      const Eigen::VectorXd out = whitening.adjoint(Eigen::VectorXd::Unit(46, row));
      EXPECT_LT((out - filter.row(row).transpose()).cwiseAbs().maxCoeff(), 1e-12) << row;
    }
  }
}

// Variance of the last of many rows when all before it are known.
TEST(RowVariance, IsWhatTheRowsBeforeLeaveOpen) {
  for (const double share : {1.0, 0.6, 0.05}) {
    Noise noise;
    noise.within_sd = 1.3;
    noise.slow_share = share;
    noise.slow_rho = 0.9;
    EXPECT_DOUBLE_EQ(noise.row_variance(), 1.3 * 1.3);  // rows as they are
    noise.whitened = true;
    const Eigen::MatrixXd root = covariance_of(noise, 1, 300).llt().matrixL();
    EXPECT_NEAR(noise.row_variance(), root(299, 299) * root(299, 299), 1e-9) << share;
  }
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
  noise.slow_share = 0.6;
  noise.slow_rho = 0.9;
  noise.whitened = true;
  const Eigen::MatrixXd with = covariance_of(noise, 1, 20);
  const Eigen::MatrixXd without = with.array() - 1.5 * 1.5;
  EXPECT_NEAR(offset_nats(clusters, noise)[0],
              0.5 * std::log(with.determinant() / without.determinant()), 1e-9);
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
