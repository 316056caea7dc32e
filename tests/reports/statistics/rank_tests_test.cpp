// SPDX-License-Identifier: MIT
#include "reports/statistics/rank_tests.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>
#include <vector>

#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"
#include "reports/statistics/distributions.hpp"

namespace tribench {
namespace {

// Hollander, Wolfe 1973, p. 29: depression scores before and after; R's help page of wilcox.test
// prints V = 40 and a one-sided p of 0.01953.
TEST(WilcoxonSignedRank, GivesTheTextbooksAnswerForTheDepressionScores) {
  const std::array<double, 9> x = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::array<double, 9> y = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (std::size_t i = 0; i < x.size(); ++i) differences.push_back(x[i] - y[i]);
  const SignedRankTest test = wilcoxon_signed_rank(differences);
  EXPECT_EQ(test.rank_sum_positive, 40);
  EXPECT_EQ(test.rank_sum_negative, 5);
  EXPECT_TRUE(test.exact);
  EXPECT_NEAR(test.p, 2 * 0.01953125, 1e-12);
  EXPECT_NEAR(test.effect, 35.0 / 45, 1e-12);
}

TEST(WilcoxonSignedRank, CountsEverySignPatternOfTiedRanksExactly) {
  // Three equal differences: of 8 sign patterns only +++ and --- are as extreme.
  const std::array<double, 3> differences = {2, 2, 2};
  EXPECT_NEAR(wilcoxon_signed_rank(differences).p, 0.25, 1e-15);
  // Ranks 1, 2.5, 2.5 with the 1 negative: sums of the negatives <= 1 are {} and {1}: 2 * 2/8.
  const std::array<double, 3> tied = {-1, 2, 2};
  EXPECT_NEAR(wilcoxon_signed_rank(tied).p, 0.5, 1e-15);
}

TEST(WilcoxonSignedRank, LeavesOutZerosAndNaNAndRanksInfinityLast) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::array<double, 5> differences = {0, nan, 1, 2, -inf};
  const SignedRankTest test = wilcoxon_signed_rank(differences);
  EXPECT_EQ(test.pairs, 3U);
  EXPECT_EQ(test.rank_sum_negative, 3);
  EXPECT_EQ(wilcoxon_signed_rank({}).p, 1);
}

TEST(WilcoxonSignedRank, ApproximationAgreesWithTheExactTestWhereTheyMeet) {
  RandomStream random(3);
  std::vector<double> differences;
  for (int i = 0; i < 60; ++i) differences.push_back(random.normal() + 0.25);
  const SignedRankTest exact = wilcoxon_signed_rank(differences);
  differences.push_back(1e-9);  // one more pair of the lowest rank: the approximation takes over
  const SignedRankTest approximate = wilcoxon_signed_rank(differences);
  EXPECT_TRUE(exact.exact);
  EXPECT_FALSE(approximate.exact);
  EXPECT_NEAR(approximate.p, exact.p, 0.1 * exact.p);
}

TEST(WilcoxonSignedRank, CriesWolfAsOftenAsItsLevelSays) {
  RandomStream random(11);
  constexpr int kStudies = 4000;
  int alarms = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::array<double, 12> differences{};
    for (double& difference : differences) difference = random.normal();
    if (wilcoxon_signed_rank(differences).p <= 0.05) ++alarms;
  }
  EXPECT_LE(alarms, kStudies * 0.05 + 4 * std::sqrt(kStudies * 0.05 * 0.95));
  EXPECT_GE(alarms, kStudies * 0.03);
}

// Demsar 2006, section 3.2.2: p-values 0.016, 0.019, 0.607 against alpha/3, alpha/2, alpha.
TEST(Holm, AdjustsStepByStepAndNeverLetsALargerPOvertake) {
  const std::array<double, 4> p = {0.607, 0.016, std::nan(""), 0.019};
  const std::vector<double> adjusted = holm(p);
  EXPECT_NEAR(adjusted[1], 0.048, 1e-12);
  EXPECT_NEAR(adjusted[3], 0.048, 1e-12);
  EXPECT_NEAR(adjusted[0], 0.607, 1e-12);
  EXPECT_TRUE(std::isnan(adjusted[2]));
}

// Demsar 2006, table 6: ranks of C4.5, C4.5+m, C4.5+cf, C4.5+m+cf on 14 data sets.
constexpr std::array<double, 56> kDemsarRanks = {
    4,   3,   2,   1,   1,   2,   3, 4, 4, 1,   2,   3, 4, 1, 3, 2, 4, 2,   3,
    1,   1,   2.5, 4,   2.5, 3,   2, 4, 1, 2.5, 2.5, 4, 1, 4, 3, 2, 1, 2.5, 2.5,
    2.5, 2.5, 4,   2.5, 1,   2.5, 3, 2, 4, 1,   4,   1, 2, 3, 3, 1, 4, 2};

TEST(Friedman, GivesThePublishedRanksAndStatisticOfDemsarsExample) {
  const FriedmanTest test = friedman(kDemsarRanks, 4, 0.05);
  ASSERT_EQ(test.blocks, 14U);
  EXPECT_NEAR(test.mean_ranks[0], 3.143, 5e-4);
  EXPECT_NEAR(test.mean_ranks[1], 2.000, 5e-4);
  EXPECT_NEAR(test.mean_ranks[2], 2.893, 5e-4);
  EXPECT_NEAR(test.mean_ranks[3], 1.964, 5e-4);
  // The paper prints 9.28 without correction for ties; here 78 of 840 are tied.
  EXPECT_NEAR(test.chi_squared * (1 - 78.0 / 840), 9.28, 5e-3);
  EXPECT_NEAR(test.critical_difference, 2.569 * std::sqrt(4.0 * 5 / (6 * 14)), 1e-3);
}

TEST(Friedman, HasNothingToSayAboutOneBlockOrOneTreatment) {
  const std::array<double, 3> one_block = {1, 2, 3};
  EXPECT_EQ(friedman(one_block, 3, 0.05).p, 1);
  EXPECT_TRUE(std::isinf(friedman(one_block, 3, 0.05).critical_difference));
  EXPECT_EQ(friedman(one_block, 1, 0.05).p, 1);
}

// Demsar 2006, table 5: critical values of the two-tailed Nemenyi test.
TEST(NormalRange, GivesTheTableOfNemenyisCriticalValues) {
  const std::array<double, 9> at_5 = {1.960, 2.343, 2.569, 2.728, 2.850,
                                      2.949, 3.031, 3.102, 3.164};
  const std::array<double, 9> at_10 = {1.645, 2.052, 2.291, 2.459, 2.589,
                                       2.693, 2.780, 2.855, 2.920};
  for (int k = 2; k <= 10; ++k) {
    const auto i = static_cast<std::size_t>(k - 2);
    EXPECT_NEAR(normal_range_quantile(0.95, k) / std::sqrt(2.0), at_5[i], 1.1e-3) << k;
    EXPECT_NEAR(normal_range_quantile(0.90, k) / std::sqrt(2.0), at_10[i], 1.1e-3) << k;
  }
}

// Of two: the difference of two normals. Of a hundred: Simpson's rule at steps of 0.002.
TEST(NormalRange, IsExactToTheDigitsPromisedForFewAndForMany) {
  for (const double q : {0.01, 0.5, 2.0, 5.0, 9.0}) {
    EXPECT_NEAR(normal_range_cdf(q, 2), 2 * normal_cdf(q / std::sqrt(2.0)) - 1, 1e-13) << q;
    double sum = 0;
    for (int i = 0; i <= 10'000; ++i) {
      const double z = -10 - q + i * (20 + q) / 10'000;
      const double between = normal_cdf(z + q) - normal_cdf(z);
      const int weight = i == 0 || i == 10'000 ? 1 : 2 + 2 * (i % 2);
      sum += weight * std::exp(-z * z / 2) * std::pow(between, 99);
    }
    const double simpson = 100 * sum * (20 + q) / 30'000 / std::sqrt(2 * std::numbers::pi);
    EXPECT_NEAR(normal_range_cdf(q, 100), simpson, 1e-12) << q;
  }
  EXPECT_EQ(normal_range_cdf(0, 3), 0);
}

// Every leaderboard asks for some, also that of a run of two seconds.
TEST(NormalRange, AQuantileTakesNoTimeThatAnybodyNotices) {
  const std::clock_t start = std::clock();
  for (int k = 2; k < 12; ++k) normal_range_quantile(0.95, k);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10 * 0.05);
}

TEST(ChiSquaredTail, GivesTheTableOfCriticalValues) {
  EXPECT_NEAR(chi_squared_tail(3.841459, 1), 0.05, 1e-7);
  EXPECT_NEAR(chi_squared_tail(7.814728, 3), 0.05, 1e-7);
  EXPECT_NEAR(chi_squared_tail(15.98718, 10), 0.10, 1e-6);
  EXPECT_EQ(chi_squared_tail(0, 3), 1);
}

// Hollander and Wolfe 1973, p. 187 (tuna, as in R's cor.test): tau = 0.444.
TEST(KendallTau, GivesTheTextbooksAnswerAndCountsTies) {
  const std::array<double, 9> lightness = {44.4, 45.9, 41.9, 53.3, 44.7, 44.1, 50.7, 45.2, 60.1};
  const std::array<double, 9> panel = {2.6, 3.1, 2.5, 5.0, 3.6, 4.0, 5.2, 2.8, 3.8};
  EXPECT_NEAR(kendall_tau(lightness, panel), 4.0 / 9, 1e-12);
  // One tie in a: 2 of 3 pairs told there, 3 in b.
  EXPECT_NEAR(kendall_tau(std::array<double, 3>{1, 1, 2}, std::array<double, 3>{1, 2, 3}),
              2 / std::sqrt(6.0), 1e-12);
  EXPECT_EQ(kendall_tau(std::array<double, 2>{1, 2}, std::array<double, 2>{2, 1}), -1);
  EXPECT_EQ(kendall_tau(std::array<double, 2>{1, 1}, std::array<double, 2>{2, 1}), 0);
}

TEST(Quantile, InterpolatesAsTypeSevenAndSurvivesInfinityAndNaN) {
  const std::array<double, 4> values = {4, 1, 3, 2};
  EXPECT_EQ(median(values), 2.5);
  EXPECT_EQ(quantile(values, 0.25), 1.75);
  const double inf = std::numeric_limits<double>::infinity();
  const std::array<double, 4> wild = {inf, std::nan(""), inf, 1};
  EXPECT_EQ(median(wild), inf);
  EXPECT_TRUE(std::isnan(median(std::array<double, 1>{std::nan("")})));
}

TEST(Ranks, ShareTheMeanOfTiedPlaces) {
  const std::array<double, 4> values = {10, 20, 10, 5};
  EXPECT_EQ(ranks_of(values), (std::vector<double>{2.5, 4, 2.5, 1}));
}

}  // namespace
}  // namespace tribench
