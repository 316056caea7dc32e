// SPDX-License-Identifier: MIT
#include "reports/statistics/power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "foundation/random.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

enum class Noise { normal, uniform, student };

std::vector<double> draw(Noise noise, std::size_t pairs, RandomStream& random) {
  std::vector<double> values;
  for (std::size_t i = 0; i < pairs; ++i) {
    double value = random.normal();
    if (noise == Noise::uniform) value = random.uniform(-1, 1);
    if (noise == Noise::student) {  // 4 degrees of freedom
      double squares = 0;
      for (int k = 0; k < 4; ++k) squares += std::pow(random.normal(), 2);
      value /= std::sqrt(squares / 4);
    }
    values.push_back(value);
  }
  return values;
}

// Of `runs` runs, each with the difference planted that an earlier one says it could have seen.
double found(Noise noise, std::size_t pairs, double level, int runs) {
  RandomStream random(pairs);
  int hits = 0;
  for (int k = 0; k < runs; ++k) {
    const double shift = smallest_seen_shift(draw(noise, pairs, random), level);
    std::vector<double> planted = draw(noise, pairs, random);
    for (double& value : planted) value += shift;
    hits += wilcoxon_signed_rank(planted).p <= level ? 1 : 0;
  }
  return static_cast<double>(hits) / runs;
}

TEST(Power, OfTheDifferencesStatedFourOfFiveAreFound) {
  constexpr int kRuns = 500;
  for (const Noise noise : {Noise::normal, Noise::uniform, Noise::student}) {
    for (const std::size_t pairs : {10U, 20U, 40U}) {
      const double share = found(noise, pairs, 0.05, kRuns);
      std::printf("%zu pairs: %.1f %%\n", pairs, 100 * share);
      EXPECT_GE(share, 0.74);
      EXPECT_LE(share, 0.86);
    }
  }
}

TEST(Power, TwoHundredPairsWithThePlantedDifference) {
  const double share = found(Noise::normal, 20, 0.05, 200);
  EXPECT_GE(share, 0.74);
  EXPECT_LE(share, 0.86);
}

TEST(Power, FewPairsSeeNothingAndEqualPairsEverything) {
  const std::vector<double> few = {0.1, -0.1, 0.2};
  EXPECT_TRUE(std::isinf(smallest_seen_shift(few, 0.05)));
  const std::vector<double> equal(8, 0.0);
  EXPECT_EQ(smallest_seen_shift(equal, 0.05), 0);
  std::vector<double> broken(8, 0.5);
  broken[3] = std::numeric_limits<double>::infinity();
  broken[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(smallest_seen_shift(broken, 0.05), 0);
  // Twice the noise, twice the difference.
  const std::vector<double> some = {0.3, -0.2, 0.1, 0.5, -0.4, 0.2, -0.1, 0.7, -0.6, 0.05};
  std::vector<double> twice = some;
  for (double& value : twice) value *= 2;
  EXPECT_NEAR(smallest_seen_shift(twice, 0.05), 2 * smallest_seen_shift(some, 0.05), 1e-12);
}

}  // namespace
}  // namespace tribench
