// SPDX-License-Identifier: MIT
#include "harness/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace tribench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ComputeErrors, AgreesWithFiguresComputedByHand) {
  const double values[] = {1, 2, 3, 5};
  const double target[] = {1, 1, 5, 5};
  const ErrorFigures figures = compute_errors(values, target);
  EXPECT_DOUBLE_EQ(figures.mae, 0.75);
  EXPECT_DOUBLE_EQ(figures.rmse, std::sqrt(5.0 / 4));
  EXPECT_DOUBLE_EQ(figures.max_error, 2);
  EXPECT_DOUBLE_EQ(figures.r2, 1 - 5.0 / 16);
  EXPECT_DOUBLE_EQ(figures.relative, 100 * std::sqrt(5.0 / 52));
}

TEST(ComputeErrors, LeavesOutRowsWithoutATarget) {
  const double values[] = {1, 99, 3};
  const double target[] = {2, kNan, 4};
  const ErrorFigures figures = compute_errors(values, target);
  EXPECT_EQ(figures.rows, 2U);
  EXPECT_DOUBLE_EQ(figures.mae, 1);
}

TEST(ComputeErrors, GivesNoFigureWhereTheFormulaHasNoValue) {
  const double values[] = {1, std::numeric_limits<double>::infinity(), kNan};
  const double target[] = {1, 2, 3};
  const ErrorFigures figures = compute_errors(values, target);
  EXPECT_EQ(figures.not_finite, 2U);
  EXPECT_TRUE(std::isnan(figures.mae));
  EXPECT_TRUE(std::isnan(figures.r2));
}

TEST(ComputeErrors, GivesNoFigureForOneInfiniteValueNorForNoRow) {
  const double values[] = {1, std::numeric_limits<double>::infinity()};
  const double target[] = {1, 2};
  EXPECT_TRUE(std::isnan(compute_errors(values, target).mae));
  EXPECT_TRUE(std::isnan(compute_errors(values, target).max_error));
  EXPECT_TRUE(std::isnan(compute_errors({}, {}).mae));
}

TEST(ComputeErrors, TheLargestErrorMayBeSmall) {
  const double values[] = {1, 2.25};
  const double target[] = {1, 2};
  EXPECT_DOUBLE_EQ(compute_errors(values, target).max_error, 0.25);
}

// Ten tenths have a mean that is not a tenth.
TEST(ComputeErrors, AConstantHasNoVariance) {
  const std::vector<double> target(10, 0.1);
  std::vector<double> values = target;
  EXPECT_TRUE(std::isnan(compute_errors(values, target).r2));
  EXPECT_EQ(compute_errors(values, target).relative, 0);
  values[0] = 0.2;
  EXPECT_TRUE(std::isnan(compute_errors(values, target).r2));
  const std::vector<double> zeros(3, 0.0);
  EXPECT_EQ(compute_errors(zeros, zeros).relative, 0);
}

TEST(ComputeErrors, GivesNoRatioWhereItHasNoMeaning) {
  const double values[] = {1, 2};
  const double zeros[] = {0, 0};
  const ErrorFigures figures = compute_errors(values, zeros);
  EXPECT_DOUBLE_EQ(figures.mae, 1.5);
  EXPECT_TRUE(std::isnan(figures.r2));
  EXPECT_TRUE(std::isnan(figures.relative));
}

}  // namespace
}  // namespace tribench
