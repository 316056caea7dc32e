// SPDX-License-Identifier: MIT
#include "harness/loop/loop_judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench::loop {
namespace {

// Rows of which the models' errors are known: the target is what they miss by.
Observations rows_of(const std::vector<int>& movement) {
  Observations data;
  data.movement = movement;
  data.target.assign(movement.size(), 10.0);
  return data;
}

Eigen::VectorXd missed_by(const std::vector<double>& errors) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(errors.size()));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = 10 - errors[i];
  }
  return out;
}

TEST(LoopJudge, GivesTheErrorsOfBothModelsRowByRowAndMovementByMovement) {
  const std::vector<int> movement = {4, 4, 9, 9, 9};
  const ErrorFinding error = judge(rows_of(movement), missed_by({1, -1, 2, 2, 2}),
                                   missed_by({0.5, -0.5, 1, 1, -1}), movement, RandomStream(1));
  EXPECT_NEAR(error.mae_before, 8.0 / 5, 1e-12);
  EXPECT_NEAR(error.mae_after, 4.0 / 5, 1e-12);
  EXPECT_NEAR(error.rmse_before, std::sqrt(14.0 / 5), 1e-12);
  EXPECT_NEAR(error.rmse_after, std::sqrt(3.5 / 5), 1e-12);
  EXPECT_NEAR(error.max_before, 2, 1e-12);
  EXPECT_NEAR(error.max_after, 1, 1e-12);
  ASSERT_EQ(error.test_movements, 2U);
  ASSERT_EQ(error.movements.size(), 2U);
  EXPECT_EQ(error.movements[0].movement, 4);
  EXPECT_EQ(error.movements[1].movement, 9);
  EXPECT_EQ(error.movements[0].rows, 2U);
  EXPECT_EQ(error.movements[1].rows, 3U);
  EXPECT_NEAR(error.movements[0].before, 1, 1e-12);
  EXPECT_NEAR(error.movements[0].after, 0.5, 1e-12);
  EXPECT_NEAR(error.movements[1].before, 2, 1e-12);
  EXPECT_NEAR(error.movements[1].after, 1, 1e-12);
  // Errors of both signs cancel in a movement's mean.
  EXPECT_NEAR(error.movements[0].mean_before, 0, 1e-12);
  EXPECT_NEAR(error.movements[1].mean_before, 2, 1e-12);
  EXPECT_NEAR(error.movements[1].mean_after, 1.0 / 3, 1e-12);
  EXPECT_NEAR(error.means_before, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(error.means_after, std::sqrt(1.0 / 18), 1e-12);
}

// Units that gain 1 and 3 alike: their mean lies within 1.96 standard errors of 2.
TEST(LoopJudge, BoundsTheGainByWhatItsUnitsDifferBy) {
  constexpr int kUnits = 100;
  std::vector<int> unit;
  std::vector<double> before;
  std::vector<double> after;
  for (int k = 0; k < kUnits; ++k) {
    // A unit counts once, however many rows it has.
    for (int i = 0; i < (k % 2 == 0 ? 2 : 7); ++i) {
      unit.push_back(k);
      before.push_back(k % 2 == 0 ? 3 : -5);
      after.push_back(2);
    }
  }
  const std::vector<int> one_movement(unit.size(), 0);
  const ErrorFinding error =
      judge(rows_of(one_movement), missed_by(before), missed_by(after), unit, RandomStream(2));
  EXPECT_EQ(error.test_movements, 1U);
  EXPECT_NEAR(error.difference_low, 2 - 0.196, 0.03);
  EXPECT_NEAR(error.difference_high, 2 + 0.196, 0.03);
}

TEST(LoopJudge, HasNoFiguresWithoutRows) {
  const ErrorFinding error = judge({}, Eigen::VectorXd(), Eigen::VectorXd(), {}, RandomStream(1));
  EXPECT_EQ(error.test_movements, 0U);
  EXPECT_TRUE(std::isnan(error.mae_before));
  EXPECT_TRUE(std::isnan(error.difference_high));
}

}  // namespace
}  // namespace tribench::loop
