// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "problems/catalogue.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

TEST(NguyenProblems, HaveThePublishedRowsAndRanges) {
  const Catalogue catalogue;
  for (int number = 1; number <= 12; ++number) {
    const ProblemEntry& entry = catalogue.find("nguyen/" + std::to_string(number));
    const Problem problem = entry.make(1);
    const Table& train = problem.stages[0].train;
    EXPECT_EQ(train.rows(), 20U);
    for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
      for (const double x : train.columns[j]) {
        EXPECT_GE(x, problem.inputs[j].low);
        EXPECT_LE(x, problem.inputs[j].high);
      }
    }
    EXPECT_NE(entry.make(2).stages[0].train.target, train.target);
    EXPECT_EQ(entry.make(1).stages[0].train.target, train.target);
  }
  // Nguyen-7 at a point worked by hand: log(2) + log(2) at x = 1.
  const Problem seventh = catalogue.find("nguyen/7").make(1);
  for (std::size_t r = 0; r < seventh.test.rows(); ++r) {
    const double x = seventh.test.columns[0][r];
    EXPECT_NEAR(std::exp(seventh.test.target[r]), (x + 1) * (x * x + 1), 1e-12);
  }
}

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
