// SPDX-License-Identifier: MIT
#include "algorithms/inference/flips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/inference/float_lanes.hpp"

namespace tribench::loop {
namespace {

FloatRows random_scores(Eigen::Index clusters, Eigen::Index columns, RandomStream random) {
  FloatRows scores(clusters, columns);
  for (Eigen::Index i = 0; i < scores.size(); ++i) {
    scores.data()[i] = static_cast<float>(random.normal());
  }
  return scores;
}

// Clusters and columns that fill no group and no tile, flips that fill no pair.
TEST(Flips, SumsAreThoseOfTheSigns) {
  for (const std::size_t clusters : {1U, 4U, 23U, 64U}) {
    for (const Eigen::Index columns : {1, 16, 37}) {
      const Flips flips(31, clusters, RandomStream(clusters));
      const FloatRows scores =
          random_scores(static_cast<Eigen::Index>(clusters), columns, RandomStream(9));
      constexpr std::size_t kFirst = 6;
      const FloatRows sums = flips.sums(scores, kFirst, 25);
      ASSERT_EQ(sums.rows(), 25);
      for (Eigen::Index b = 0; b < sums.rows(); ++b) {
        Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(columns);
        for (std::size_t c = 0; c < clusters; ++c) {
          const int sign = flips.sign(kFirst + static_cast<std::size_t>(b), c);
          expected += sign * scores.row(static_cast<Eigen::Index>(c)).cast<double>();
        }
        EXPECT_LT((sums.row(b).cast<double>() - expected).cwiseAbs().maxCoeff(), 1e-5);
      }
    }
  }
}

// Clusters that fill no group, flips that fill no pair; pairs stand kLanes apart.
TEST(Flips, LargestSquaresAreThoseOfTheSums) {
  for (const std::size_t clusters : {1U, 23U, 64U}) {
    for (const Eigen::Index columns : {16, 48}) {
      const Flips flips(31, clusters, RandomStream(clusters));
      const FloatRows pairs =
          random_scores(static_cast<Eigen::Index>(clusters), columns, RandomStream(9));
      constexpr std::size_t kFirst = 6;
      const FloatRows sums = flips.sums(pairs, kFirst, 25);
      const std::vector<float> largest = flips.largest_squares(pairs, kFirst, 25);
      ASSERT_EQ(largest.size(), 25U);
      for (Eigen::Index b = 0; b < sums.rows(); ++b) {
        float expected = 0;
        for (Eigen::Index tile = 0; tile < columns; tile += 2 * kLanes) {
          for (Eigen::Index j = tile; j < tile + Eigen::Index{kLanes}; ++j) {
            expected = std::max(
                expected, sums(b, j) * sums(b, j) + sums(b, j + kLanes) * sums(b, j + kLanes));
          }
        }
        EXPECT_EQ(largest[static_cast<std::size_t>(b)], expected) << clusters << " " << b;
      }
    }
  }
}

// All 64 bits of each number drawn, one a sign.
TEST(Flips, AreTheBitsOfTheirStream) {
  constexpr std::size_t kClusters = 7;
  const Flips flips(40, kClusters, RandomStream(4));
  RandomStream random(4);
  std::uint64_t word = 0;
  for (std::size_t k = 0; k < 40 * kClusters; ++k) {
    if (k % 64 == 0) word = random.next();
    EXPECT_EQ(flips.sign(k / kClusters, k % kClusters), (word >> (k % 64) & 1) != 0 ? 1 : -1) << k;
  }
}

TEST(Flips, AreFairAndDifferFromFlipToFlipAndFromClusterToCluster) {
  constexpr std::size_t kFlips = 400;
  constexpr std::size_t kClusters = 50;
  const Flips flips(kFlips, kClusters, RandomStream(3));
  double sum = 0;
  double neighbours = 0;
  double next = 0;
  for (std::size_t b = 0; b < kFlips; ++b) {
    for (std::size_t c = 0; c < kClusters; ++c) {
      sum += flips.sign(b, c);
      if (c > 0) neighbours += flips.sign(b, c) * flips.sign(b, c - 1);
      if (b > 0) next += flips.sign(b, c) * flips.sign(b - 1, c);
    }
  }
  const double four_errors = 4 * std::sqrt(static_cast<double>(kFlips * kClusters));
  EXPECT_LT(std::abs(sum), four_errors);
  EXPECT_LT(std::abs(neighbours), four_errors);
  EXPECT_LT(std::abs(next), four_errors);
}

}  // namespace
}  // namespace tribench::loop
