// SPDX-License-Identifier: MIT
#include "algorithms/inference/offset_grams.hpp"

#include <gtest/gtest.h>

#include "algorithms/inference/score_test.hpp"
#include "algorithms/inference/whitening.hpp"
#include "tests/algorithms/inference/normal_columns.hpp"
#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kLong = 100;  // rows of a movement: three stretches
constexpr std::size_t kFew = kMovements * kRows / kLong;

// Movements of which some count more.
struct WeighedMovements {
  Clusters clusters;
  Noise noise;
  Eigen::MatrixXd x = testing::normal_columns(kMovements * kRows, 3, 1);
  Eigen::MatrixXd more = testing::normal_columns(kMovements * kRows, 2, 2);
  Eigen::VectorXd y = noise_of(RandomStream(3), 2);

  explicit WeighedMovements(bool whitened) {
    std::vector<int> movement;
    for (std::size_t m = 0; m < kFew; ++m) {
      movement.insert(movement.end(), kLong, static_cast<int>(m));
    }
    clusters = make_clusters(movement, 1);
    for (std::size_t m = 0; m < kFew; ++m) clusters.weight.push_back(m % 3 == 0 ? 1.4 : 0.7);
    noise.within_sd = 1.5;
    noise.between_sd = kBetween;
    noise.slow_share = 0.8;
    noise.slow_rho = kRho;
    noise.whitened = whitened;
    x.col(0).setOnes();
  }

  StretchGrams by_rows(double between_sd) const {
    Noise other = noise;
    other.between_sd = between_sd;
    return stretch_grams(whitened(beside(x, more), clusters, other),
                         whitened(y, clusters, other).col(0), clusters);
  }
};

TEST(OffsetGrams, AreThoseOfTheRowsWhitenedAnew) {
  for (const bool whitened : {false, true}) {
    const WeighedMovements c(whitened);
    const OffsetGrams grams = FilteredModel(c.x, c.y, c.clusters, c.noise).beside(c.more);
    for (const double between_sd : {0.0, 0.3, 5.0}) {
      const StretchGrams expected = c.by_rows(between_sd);
      const StretchGrams found = grams.at(between_sd);
      ASSERT_EQ(found.size(), 3 * kFew);
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_LT((found[k] - expected[k]).norm(), 1e-11 * expected[k].norm()) << between_sd;
      }
      EXPECT_LT((grams.coefficients_at(between_sd) - coefficients_of(expected)).norm(), 1e-11);
    }
  }
}

TEST(OffsetGrams, SayTheSpreadOfTheOffsetsThatAFitLeaves) {
  WeighedMovements c(true);
  c.noise.within_sd = 0.1;  // so quiet that every mean tells of an offset
  const OffsetGrams grams = FilteredModel(c.x, c.y, c.clusters, c.noise).beside(c.more);
  const Eigen::VectorXd b = grams.coefficients_at(kBetween);
  const Eigen::VectorXd left = c.y - beside(c.x, c.more) * b;
  Eigen::VectorXd means(static_cast<Eigen::Index>(kFew));
  for (std::size_t m = 0; m < kFew; ++m) {
    means[static_cast<Eigen::Index>(m)] =
        left.segment(static_cast<Eigen::Index>(m * kLong), kLong).mean();
  }
  EXPECT_NEAR(grams.spread_beside(b), offset_spread(means, c.clusters, c.noise), 1e-12);
  EXPECT_GT(grams.spread_beside(b), 0);
}

}  // namespace
}  // namespace tribench::loop
