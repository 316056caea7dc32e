// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.hpp"

namespace tribench {
namespace {

TEST(LinearLeastSquares, FitsALineByHand) {
  // Through (0, 1), (1, 3), (2, 4): slope 1.5, offset 7/6, residual 1/6.
  const std::vector<double> ones = {1, 1, 1};
  const std::vector<double> x = {0, 1, 2};
  const std::vector<double> y = {1, 3, 4};
  const std::vector<const double*> columns = {ones.data(), x.data()};
  const LinearFit fit = solve_least_squares(columns, y);
  EXPECT_NEAR(fit.coefficients[0], 7.0 / 6, 1e-14);
  EXPECT_NEAR(fit.coefficients[1], 1.5, 1e-14);
  EXPECT_NEAR(fit.sum_squares, 1.0 / 6, 1e-14);
  EXPECT_EQ(fit.rank, 2);
}

TEST(LinearLeastSquares, SeesDependentColumnsWhateverTheirUnits) {
  const std::vector<double> a = {1, 2, 3, 4};
  const std::vector<double> b = {2e9, 4e9, 6e9, 8e9};
  const std::vector<double> c = {1e-9, 0, 1e-9, 0};
  const std::vector<double> y = {3, 4, 7, 8};
  const std::vector<const double*> columns = {a.data(), b.data(), c.data()};
  const LinearFit fit = solve_least_squares(columns, y);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_EQ(fit.condition, std::numeric_limits<double>::infinity());
  EXPECT_LT(fit.sum_squares, 1e-20);
  EXPECT_EQ((fit.coefficients[0] == 0) + (fit.coefficients[1] == 0), 1);
}

TEST(LinearLeastSquares, GivesAColumnOfSubnormalNumbersTheCoefficientZero) {
  const std::vector<double> ones = {1, 1, 1, 1};
  const std::vector<double> tiny = {5e-324, 1e-320, 2e-321, 3e-323};
  const std::vector<double> y = {3, 4, 7, 8};
  const std::vector<const double*> columns = {ones.data(), tiny.data()};
  const LinearFit fit = solve_least_squares(columns, y);
  EXPECT_NEAR(fit.coefficients[0], 5.5, 1e-12);
  EXPECT_EQ(fit.coefficients[1], 0);
  EXPECT_NEAR(fit.sum_squares, 17, 1e-12);
}

TEST(SolveQuadratic, MeetsTheConditionsOfOptimality) {
  RandomStream random(8);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t n = 2 + random.below(5);
    std::vector<double> factor(n * n);
    for (double& value : factor) value = random.normal();
    std::vector<double> a(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < n; ++k) a[i * n + j] += factor[i * n + k] * factor[j * n + k];
      }
    }
    std::vector<double> b(n);
    std::vector<char> held(n);
    for (std::size_t i = 0; i < n; ++i) {
      b[i] = random.normal();
      held[i] = random.chance(0.6) ? 1 : 0;
    }
    std::vector<double> x(n);
    ASSERT_TRUE(solve_quadratic(a, b, held, x));
    for (std::size_t i = 0; i < n; ++i) {
      double slope = -b[i];
      double size = std::abs(b[i]);
      for (std::size_t j = 0; j < n; ++j) {
        slope += a[i * n + j] * x[j];
        size += std::abs(a[i * n + j] * x[j]);
      }
      if (held[i] != 0) {
        EXPECT_GE(x[i], 0);
        EXPECT_GE(slope, -1e-8 * size);
        if (x[i] > 0) EXPECT_LE(slope, 1e-8 * size);
      } else {
        EXPECT_NEAR(slope, 0, 1e-8 * size);
      }
    }
  }
}

}  // namespace
}  // namespace tribench
