// SPDX-License-Identifier: MIT
#include "algorithms/inference/clusters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench::loop {
namespace {

constexpr std::size_t kMovements = 60;
constexpr std::size_t kRows = 50;
constexpr double kRho = 0.6;
constexpr double kBetween = 0.2;

Clusters many_movements() {
  std::vector<int> movement;
  for (std::size_t m = 0; m < kMovements; ++m) {
    movement.insert(movement.end(), kRows, static_cast<int>(m));
  }
  return make_clusters(movement, 1);
}

// AR(1) of unit variance, an offset a movement; odd movements are `louder` times as loud.
Eigen::VectorXd noise_of(RandomStream random, double louder) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(kMovements * kRows));
  for (std::size_t m = 0; m < kMovements; ++m) {
    const double offset = kBetween * random.normal();
    const double scale = m % 2 == 1 ? louder : 1.0;
    double x = random.normal();
    for (std::size_t i = 0; i < kRows; ++i) {
      if (i > 0) x = kRho * x + std::sqrt(1 - kRho * kRho) * random.normal();
      out[static_cast<Eigen::Index>(m * kRows + i)] = offset + scale * x;
    }
  }
  return out;
}

TEST(Whitening, LeavesRowsOfOneVarianceThatKnowNothingOfTheirNeighboursNorOfTheirMovement) {
  const Clusters clusters = many_movements();
  Noise noise;
  noise.within_sd = 1;
  noise.between_sd = kBetween;
  noise.rho = noise.whitening = kRho;
  noise.inflation = (1 + kRho) / (1 - kRho);
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

}  // namespace
}  // namespace tribench::loop
