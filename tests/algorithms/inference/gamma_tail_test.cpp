// SPDX-License-Identifier: MIT
#include "algorithms/inference/gamma_tail.hpp"

#include <gtest/gtest.h>

namespace tribench::loop {
namespace {

TEST(MatchedGamma, TheTableAgreesWithTheExactScore) {
  MatchedGamma gamma(3.0, 7.0);
  gamma.tabulate(60);
  for (double q = 0.01; q < 80; q *= 1.3) {
    EXPECT_NEAR(gamma.fast_score(q), gamma.score(q), 1e-3) << q;
  }
}

TEST(MatchedGamma, SaysNothingWhereTheStatisticCannotVary) {
  EXPECT_EQ(MatchedGamma(0, 0).score(5), 0);
  EXPECT_EQ(MatchedGamma(1, 0).score(5), 0);
}

}  // namespace
}  // namespace tribench::loop
