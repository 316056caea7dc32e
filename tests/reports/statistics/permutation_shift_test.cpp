// SPDX-License-Identifier: MIT
#include "reports/statistics/permutation_shift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "foundation/random.hpp"
#include "reports/statistics/distributions.hpp"

namespace tribench {
namespace {

// Every way to choose which scores came last, stratum by stratum.
double by_enumeration(const std::vector<ShiftStratum>& strata) {
  double observed = 0;
  std::vector<double> sums = {0};
  for (const ShiftStratum& stratum : strata) {
    const std::size_t n = stratum.scores.size();
    const double mean =
        std::accumulate(stratum.scores.begin(), stratum.scores.end(), 0.0) / static_cast<double>(n);
    std::vector<char> chosen(n, 0);
    std::fill(chosen.end() - static_cast<std::ptrdiff_t>(stratum.later), chosen.end(), 1);
    std::vector<double> own;
    bool first = true;
    do {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += chosen[i] != 0 ? stratum.scores[i] - mean : 0;
      if (first) observed += sum;  // the largest of the orders: as drawn
      first = false;
      own.push_back(sum);
    } while (std::next_permutation(chosen.begin(), chosen.end()));
    std::vector<double> all;
    for (const double a : sums) {
      for (const double b : own) all.push_back(a + b);
    }
    sums = std::move(all);
  }
  const auto hits = std::ranges::count_if(sums, [&](double s) { return s >= observed - 1e-9; });
  return static_cast<double>(hits) / static_cast<double>(sums.size());
}

TEST(PermutationShift, AgreesWithEveryOrderOneByOne) {
  RandomStream random(key_of("permutation shift test"));
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<ShiftStratum> strata;
    const bool tied = trial % 2 == 0;
    for (int k = 0; k < 4; ++k) {
      const std::size_t n = 2 + random.below(5);
      ShiftStratum stratum;
      stratum.later = 1 + random.below(n - 1);
      for (std::size_t i = 0; i < n; ++i) {
        const bool late = i + stratum.later >= n;
        const double value = random.normal() + (late ? 1.5 : 0);
        stratum.scores.push_back(tied ? std::round(value) : value);
      }
      strata.push_back(stratum);
    }
    const double exact = by_enumeration(strata);
    const double told = permutation_shift_p(strata);
    if (told == 1) continue;  // not even one standard deviation above 0
    ++compared;
    EXPECT_GE(told, exact * 0.9) << trial;
    EXPECT_LE(told, exact * 1.35) << trial;
  }
  EXPECT_GT(compared, 100);
}

TEST(PermutationShift, IsExactInTheCornerWhereEverySeedIsWorse) {
  const std::vector<ShiftStratum> strata(20, {{0.0, 1.0}, 1});
  EXPECT_NEAR(permutation_shift_p(strata) / std::pow(2.0, -20), 1, 1e-6);
  // Where nothing varies, or it is later that is smaller, nothing is told.
  EXPECT_EQ(permutation_shift_p(std::vector<ShiftStratum>(20, {{1.0, 1.0}, 1})), 1);
  EXPECT_EQ(permutation_shift_p(std::vector<ShiftStratum>(20, {{1.0, 0.0}, 1})), 1);
  EXPECT_EQ(permutation_shift_p({}), 1);
}

// Far tails: normal scores, many strata; the sum is nearly normal.
TEST(PermutationShift, FollowsTheNormalTailFarOut) {
  RandomStream random(key_of("far tail"));
  std::vector<ShiftStratum> strata;
  double statistic = 0;
  double variance = 0;
  for (int k = 0; k < 40; ++k) {
    ShiftStratum stratum;
    stratum.later = 3;
    double mean = 0;
    for (int i = 0; i < 12; ++i) {
      stratum.scores.push_back(random.normal() + (i >= 9 ? 0.6 : 0));
      mean += stratum.scores.back() / 12;
    }
    for (int i = 0; i < 12; ++i) {
      const double off = stratum.scores[static_cast<std::size_t>(i)] - mean;
      if (i >= 9) statistic += off;
      variance += off * off * 3 * 9 / (12.0 * 11);
    }
    strata.push_back(stratum);
  }
  const double z = statistic / std::sqrt(variance);
  const double told = permutation_shift_p(strata);
  std::printf("z %.2f, p %.3g, normal %.3g\n", z, told, normal_cdf(-z));
  ASSERT_GT(z, 4);
  EXPECT_NEAR(std::log(told), std::log(normal_cdf(-z)), 0.5);
}

// The level is held where noise has heavy tails and is skewed.
TEST(PermutationShift, HoldsItsLevelInSkewedHeavyTailedNoise) {
  constexpr int kTrials = 4000;
  constexpr double kLevel = 0.02;
  int hits = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream random = RandomStream(key_of("level")).split(static_cast<std::uint64_t>(trial));
    std::vector<ShiftStratum> strata;
    for (int k = 0; k < 8; ++k) {
      ShiftStratum stratum;
      stratum.later = 1;
      for (int i = 0; i < 6; ++i) stratum.scores.push_back(std::exp(1.5 * random.normal()));
      strata.push_back(stratum);
    }
    hits += permutation_shift_p(strata, kLevel) <= kLevel ? 1 : 0;
  }
  std::printf("%d of %d at %.2f\n", hits, kTrials, kLevel);
  EXPECT_LE(hits, kTrials * kLevel + 3 * std::sqrt(kTrials * kLevel));
  EXPECT_GE(hits, kTrials * kLevel / 3);
}

}  // namespace
}  // namespace tribench
