// SPDX-License-Identifier: MIT
#include "foundation/pivoted_qr.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribench {
namespace {

// 1, x and, where it is asked for, their sum at x = 0, 1, 2.
Eigen::MatrixXd line(bool dependent) {
  Eigen::MatrixXd x(3, dependent ? 3 : 2);
  x.col(0).setOnes();
  x.col(1) << 0, 1, 2;
  if (dependent) x.col(2) = x.col(0) + x.col(1);
  return x;
}

TEST(PivotedQr, FitsALineByHand) {
  // Through (0, 1), (1, 3), (2, 4): offset 7/6, slope 1.5.
  const PivotedQr qr(line(false));
  const Eigen::Vector3d y(1, 3, 4);
  EXPECT_TRUE(qr.solve(y).isApprox(Eigen::Vector2d(7.0 / 6, 1.5), 1e-14));
  Eigen::MatrixXd both(3, 2);
  both << y, -2 * y;
  EXPECT_TRUE(qr.solve_each(both).col(1).isApprox(Eigen::Vector2d(-7.0 / 3, -3), 1e-14));
  EXPECT_EQ(qr.rank(), 2);
}

TEST(PivotedQr, AColumnThatFollowsFromOthersGetsNothing) {
  const Eigen::MatrixXd x = line(true);
  const Eigen::Vector3d y(1, 3, 4);
  const PivotedQr qr(x);
  EXPECT_EQ(qr.rank(), 2);
  EXPECT_EQ((qr.solve(y).array() == 0).count(), 1);
  EXPECT_TRUE((x * qr.solve(y)).isApprox(line(false) * Eigen::Vector2d(7.0 / 6, 1.5), 1e-14));
  EXPECT_TRUE(std::isinf(qr.condition()));
}

TEST(PivotedQr, TheBaseIsOrthonormalAndSpansTheColumns) {
  const Eigen::MatrixXd x = line(true);
  const Eigen::MatrixXd q = PivotedQr(x).basis();
  ASSERT_EQ(q.cols(), 2);
  EXPECT_TRUE((q.transpose() * q).isIdentity(1e-14));
  EXPECT_TRUE((q * (q.transpose() * x)).isApprox(x, 1e-14));
}

TEST(PivotedQr, ThePivotsThresholdIsOfTheLargest) {
  const Eigen::MatrixXd x = Eigen::Vector2d(2, 2e-7).asDiagonal();
  EXPECT_EQ(PivotedQr(x).rank(), 2);
  EXPECT_EQ(PivotedQr(x, 1e-6).rank(), 1);
  EXPECT_NEAR(PivotedQr(x).condition(), 1e7, 1e-3);
}

}  // namespace
}  // namespace tribench
