// SPDX-License-Identifier: MIT
#include "algorithms/inference/robust_ridge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "algorithms/fitting/symmetric_system.hpp"
#include "tests/algorithms/inference/normal_columns.hpp"

namespace tribench::loop {
namespace {

using testing::normal_columns;

std::vector<Eigen::Index> first_rows(Eigen::Index count) {
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

double root_mean_square_of(const Eigen::VectorXd& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
}

TEST(RobustRidge, LeavesTheNoiseOfRowsThatItWasNotFittedTo) {
  const Eigen::MatrixXd x = normal_columns(4000, 3, 1);
  const Eigen::VectorXd noise = 0.1 * normal_columns(4000, 1, 2);
  const Eigen::VectorXd left =
      robust_ridge_residual(x, x * Eigen::Vector3d(2, -1, 0.5) + noise, first_rows(2000));
  EXPECT_NEAR(root_mean_square_of(left.tail(2000)), 0.1, 0.005);
}

TEST(RobustRidge, ABurstBendsItLessThanLeastSquares) {
  const Eigen::MatrixXd x = normal_columns(1000, 2, 3);
  Eigen::VectorXd y = x * Eigen::Vector2d(1, 1) + 0.1 * normal_columns(1000, 1, 4);
  for (Eigen::Index i = 100; i < 120; ++i) y[i] += 30 * x(i, 0);
  const auto rows = first_rows(1000);
  const auto quiet_part = [](const Eigen::VectorXd& left) {
    return root_mean_square_of(left.tail(800));
  };
  const Eigen::Vector2d least_squares = solve_symmetric(x.transpose() * x, x.transpose() * y);
  const double plain = quiet_part(y - x * least_squares);
  EXPECT_GT(plain, 0.3) << "the burst is too small to say anything";
  EXPECT_LT(quiet_part(robust_ridge_residual(x, y, rows)), 0.75 * plain);
}

// Two columns that are the same, one of zeros, one that is not finite: no others get a weight.
TEST(RobustRidge, DoesWithoutColumnsThatSayNothing) {
  const Eigen::MatrixXd x = normal_columns(600, 1, 5);
  const Eigen::VectorXd y = 3 * x.col(0) + 0.1 * normal_columns(600, 1, 6);
  Eigen::MatrixXd more(600, 4);
  more << x, 1e6 * x, Eigen::VectorXd::Zero(600), Eigen::VectorXd::Constant(600, 1);
  more(7, 3) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::VectorXd left = robust_ridge_residual(more, y, first_rows(600));
  ASSERT_TRUE(left.allFinite());
  EXPECT_NEAR(root_mean_square_of(left), 0.1, 0.01);
}

TEST(RobustRidge, MirroredRowsGiveMirroredResiduals) {
  const Eigen::MatrixXd x = normal_columns(300, 2, 7);
  const Eigen::VectorXd y = normal_columns(300, 1, 8);
  const auto rows = first_rows(250);
  EXPECT_EQ(robust_ridge_residual(x, -y, rows), -robust_ridge_residual(x, y, rows));
}

}  // namespace
}  // namespace tribench::loop
