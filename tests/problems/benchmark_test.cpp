// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "problems/catalogue.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

TEST(PeerProblems, HaveNoiseOfTheStatedSizeAndATestGridWithoutZero) {
  const Catalogue catalogue;
  for (const auto& [name, noise, rows] :
       {std::tuple{"peer/friction1d", 0.05, 200U}, std::tuple{"peer/load4d", 0.3, 5000U}}) {
    const Problem problem = catalogue.find(name).make(3);
    const Table& train = problem.stages[0].train;
    ASSERT_EQ(train.rows(), rows);
    double square = 0;
    for (std::size_t r = 0; r < rows; ++r) square += std::pow(train.target[r] - train.truth[r], 2);
    EXPECT_NEAR(std::sqrt(square / rows), noise, 0.2 * noise);
    EXPECT_EQ(problem.test.rows(), 2000U);
    EXPECT_EQ(problem.test.target, problem.test.truth);
    for (const double v : problem.test.columns[0]) EXPECT_NE(v, 0);
  }
}

TEST(PeerProblems, ReadTheRowsTheOthersWereGiven) {
  const auto reference = testing::shared_reference();
  if (!reference) GTEST_SKIP() << testing::kNoSharedData;
  const Catalogue catalogue(reference);
  const Problem problem = catalogue.find("peer_problems/load4d").make(1);
  const Table& train = problem.stages[0].train;
  ASSERT_EQ(train.rows(), 5000U);
  EXPECT_EQ(train.columns[0][0], 1.749399799685171);
  EXPECT_EQ(train.columns[2][0], -12.445008821829411);
  EXPECT_EQ(train.target[0], 26.000787274151822);
  double square = 0;
  for (std::size_t r = 0; r < 5000; ++r) square += std::pow(train.target[r] - train.truth[r], 2);
  EXPECT_NEAR(std::sqrt(square / 5000), 0.3, 0.02);
}

}  // namespace
}  // namespace tribench
