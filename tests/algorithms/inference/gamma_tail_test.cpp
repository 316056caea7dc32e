// SPDX-License-Identifier: MIT
#include "algorithms/inference/gamma_tail.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace tribench::loop {
namespace {

TEST(MatchedGamma, TheTableAgreesWithTheExactScore) {
  MatchedGamma gamma(3.0, 7.0);
  gamma.tabulate(60);
  for (double q = 0.01; q < 80; q *= 1.3) {
    EXPECT_NEAR(gamma.fast_score(q), gamma.score(q), 1e-3) << q;
  }
}

// 96 places at even steps of the square root, straight between them; exact beyond.
TEST(MatchedGamma, TheTableIsExactInItsPlacesAndReadBetweenThem) {
  MatchedGamma gamma(3.0, 7.0);
  gamma.tabulate(60);
  const double step = std::sqrt(60.0) / 95;
  for (int k = 0; k < 95; ++k) {
    const double place = step * k * step * k;
    const double next = step * (k + 1) * step * (k + 1);
    EXPECT_NEAR(gamma.fast_score(place * (1 + 1e-14)), gamma.score(place), 1e-9) << k;
    const double middle = step * (k + 0.5) * step * (k + 0.5);
    EXPECT_NEAR(gamma.fast_score(middle), 0.5 * (gamma.score(place) + gamma.score(next)), 1e-9);
  }
  EXPECT_EQ(gamma.fast_score(61), gamma.score(61));
}

// The place before the first one that has the score.
TEST(MatchedGamma, KnowsBelowWhatNothingHasAScore) {
  MatchedGamma gamma(3.0, 7.0);
  EXPECT_EQ(gamma.none_below(1), 0);  // without a table
  gamma.tabulate(60);
  const double step = std::sqrt(60.0) / 95;
  for (const double score : {0.5, 1.0, 4.0}) {
    const double place = gamma.none_below(score);
    EXPECT_GT(place, 0);
    EXPECT_LT(gamma.fast_score(place), score);
    const double root = std::sqrt(place) + step;
    EXPECT_GE(gamma.fast_score(root * root * (1 + 1e-14)), score);
  }
  EXPECT_EQ(gamma.none_below(-1), 0);
}

TEST(MatchedGamma, SaysNothingWhereTheStatisticCannotVary) {
  EXPECT_EQ(MatchedGamma(0, 0).score(5), 0);
  EXPECT_EQ(MatchedGamma(1, 0).score(5), 0);
  EXPECT_EQ(MatchedGamma(0, 1).score(5), 0);
  EXPECT_EQ(MatchedGamma(1, 0).statistic_of(2), 0);
  MatchedGamma none(0, 1);
  none.tabulate(60);
  EXPECT_EQ(none.fast_score(5), 0);
}

TEST(MatchedGamma, TheTableIsAskedForNoPlaceThatItHasNot) {
  MatchedGamma gamma(3.0, 7.0);
  gamma.tabulate(60);
  EXPECT_EQ(gamma.fast_score(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(gamma.fast_score(-1e-17), 0);  // rounding
  EXPECT_EQ(gamma.fast_score(std::numeric_limits<double>::infinity()),
            std::numeric_limits<double>::infinity());
}

// Mean 2 and variance 4 are an exponential law: P(Q >= q) = exp(-q / 2).
TEST(MatchedGamma, HasTheTailOfTheLawItMatches) {
  const MatchedGamma exponential(2, 4);
  for (const double q : {0.1, 1.0, 10.0, 100.0}) {
    EXPECT_NEAR(exponential.score(q), q / 2 / std::numbers::ln10, 1e-9 * (1 + q)) << q;
    EXPECT_NEAR(exponential.statistic_of(exponential.score(q)), q, 1e-9 * q);
  }
}

// A statistic in other units is as unlikely as before, in the table as well.
TEST(MatchedGamma, SaysTheSameInAnyUnit) {
  MatchedGamma plain(3.0, 7.0);
  plain.tabulate(60);
  for (const double unit : {1e-9, 0.1, 1e6}) {
    MatchedGamma scaled(3.0 * unit, 7.0 * unit * unit);
    for (const double q : {0.5, 4.0, 40.0}) {
      EXPECT_NEAR(scaled.score(q * unit), plain.score(q), 1e-9);
      EXPECT_NEAR(scaled.statistic_of(2) / unit, plain.statistic_of(2), 1e-6);
    }
    scaled.tabulate(60 * unit);
    EXPECT_NEAR(scaled.fast_score(33 * unit), plain.fast_score(33), 1e-9);
  }
}

}  // namespace
}  // namespace tribench::loop
