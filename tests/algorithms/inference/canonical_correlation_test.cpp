// SPDX-License-Identifier: MIT
#include "algorithms/inference/canonical_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/algorithms/inference/normal_columns.hpp"

namespace tribench::loop {
namespace {

using testing::normal_columns;

TEST(CanonicalCorrelation, IsTheCosineOfTheAngleBetweenTwoColumns) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(40, 1);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(40, 1);
  a(3) = 2;
  b(3) = std::cos(0.7);
  b(9) = std::sin(0.7);
  EXPECT_NEAR(canonical_correlation(a, b), std::cos(0.7), 1e-12);
  EXPECT_NEAR(canonical_correlation(a, -3 * b), std::cos(0.7), 1e-12) << "sign and size";
}

TEST(CanonicalCorrelation, FindsTheDirectionThatBothHave) {
  const Eigen::MatrixXd a = normal_columns(500, 3, 1);
  Eigen::MatrixXd b = normal_columns(500, 2, 2);
  const double apart = canonical_correlation(a, b);
  EXPECT_LT(apart, 0.3);
  b.col(1) += 10 * a * Eigen::Vector3d(1, -2, 0.5) - b.col(1);
  EXPECT_NEAR(canonical_correlation(a, b), 1, 1e-9);
}

TEST(CanonicalCorrelation, IsTheSameForOtherColumnsOfTheSameSpace) {
  const Eigen::MatrixXd a = normal_columns(200, 3, 3);
  const Eigen::MatrixXd b = normal_columns(200, 2, 4) + a.leftCols(2);
  Eigen::Matrix3d mixed;
  mixed << 1, 2, 0, 0, 1e3, -1, 1, 0, 1e-3;
  EXPECT_NEAR(canonical_correlation(a * mixed, b), canonical_correlation(a, b), 1e-9);
}

TEST(CanonicalCorrelation, OfNothingIsNone) {
  const Eigen::MatrixXd a = normal_columns(20, 2, 5);
  EXPECT_EQ(canonical_correlation(a, Eigen::MatrixXd::Zero(20, 2)), 0);
  EXPECT_EQ(canonical_correlation(Eigen::MatrixXd(20, 0), a), 0);
}

}  // namespace
}  // namespace tribench::loop
