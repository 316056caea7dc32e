// SPDX-License-Identifier: MIT
#include "reports/statistics/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Wilson, GivesThePublishedIntervals) {
  // Agresti, Coull 1998: 8 of 10 and 0 of 10 at 95 %.
  EXPECT_NEAR(wilson(8, 10, 0.95).low, 0.4902, 5e-5);
  EXPECT_NEAR(wilson(8, 10, 0.95).high, 0.9433, 5e-5);
  EXPECT_NEAR(wilson(0, 10, 0.95).low, 0, 1e-12);
  EXPECT_NEAR(wilson(0, 10, 0.95).high, 0.2775, 5e-5);
  EXPECT_EQ(wilson(0, 0, 0.95).high, 1);
}

TEST(MedianInterval, IsBetweenTheOrderStatisticsOfTheBinomialTable) {
  std::vector<double> values(10);
  std::iota(values.begin(), values.end(), 1.0);
  // Ten values at 95 %: the second and the ninth (97.9 %); fifteen: the fourth and the twelfth.
  EXPECT_EQ(median_interval(values, 0.95).low, 2);
  EXPECT_EQ(median_interval(values, 0.95).high, 9);
  values.resize(15);
  std::iota(values.begin(), values.end(), 1.0);
  EXPECT_EQ(median_interval(values, 0.95).low, 4);
  EXPECT_EQ(median_interval(values, 0.95).high, 12);
  // 2 * 2^-6 < 5 % < 2 * 2^-5: six are the fewest.
  values.resize(6);
  EXPECT_EQ(median_interval(values, 0.95).low, 1);
  EXPECT_EQ(median_interval(values, 0.95).high, 6);
  values.resize(5);
  EXPECT_TRUE(std::isnan(median_interval(values, 0.95).low));
}

TEST(MedianInterval, CoversTheMedianOfASkewedLawAtLeastAsOftenAsItClaims) {
  RandomStream random(6);
  constexpr int kStudies = 2000;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> values(12);
    for (double& value : values) value = std::exp(2 * random.normal());
    if (median_interval(values, 0.95).contains(1)) ++covered;
  }
  EXPECT_GE(covered, 0.95 * kStudies);
}

TEST(Bootstrap, CoversTheTrueMeanNearlyAsOftenAsItClaims) {
  RandomStream random(5);
  constexpr int kStudies = 400;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> values(40);
    for (double& value : values) value = 2 + random.normal();
    if (bootstrap(values, mean, 0.95, 400, random.split(static_cast<std::uint64_t>(study)))
            .contains(2)) {
      ++covered;
    }
  }
  // The percentile interval is a little too narrow at n = 40: between 91 and 97.5 %.
  EXPECT_GE(covered, kStudies * 0.91);
  EXPECT_LE(covered, kStudies * 0.975);
}

TEST(TwoLevelBootstrap, IsWiderThanOneLevelWhereGroupsDiffer) {
  RandomStream random(6);
  std::vector<std::vector<double>> groups;
  std::vector<double> flat;
  for (int g = 0; g < 8; ++g) {
    const double shift = 3 * random.normal();
    groups.emplace_back();
    for (int i = 0; i < 20; ++i) groups.back().push_back(shift + random.normal());
    flat.insert(flat.end(), groups.back().begin(), groups.back().end());
  }
  const ConfidenceInterval two = two_level_bootstrap(groups, mean, 0.95, 1000, random.split("two"));
  const ConfidenceInterval one = bootstrap(flat, mean, 0.95, 1000, random.split("one"));
  EXPECT_GT(two.high - two.low, 1.8 * (one.high - one.low));
}

TEST(Bootstrap, IsTheSameForTheSameStreamAndEmptyForNothing) {
  const std::vector<double> values = {1, 2, 4, 8};
  const ConfidenceInterval a = bootstrap(values, mean, 0.9, 100, RandomStream(1));
  const ConfidenceInterval b = bootstrap(values, mean, 0.9, 100, RandomStream(1));
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_TRUE(std::isnan(bootstrap({}, mean, 0.9, 10, RandomStream(1)).low));
}

}  // namespace
}  // namespace tribench
