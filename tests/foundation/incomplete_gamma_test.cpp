// SPDX-License-Identifier: MIT
#include "foundation/incomplete_gamma.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tribench {
namespace {

// For integer a: Q(a, x) = e^-x sum_{k<a} x^k / k!, summed in logarithms.
double log_tail_of_integer_shape(int a, double x) {
  double sum = 0;
  double term = 1;
  for (int k = 0; k < a; ++k) {
    sum += term;
    term *= x / (k + 1);
  }
  return std::log(sum) - x;
}

class GammaTailAtScore : public ::testing::TestWithParam<double> {};

TEST_P(GammaTailAtScore, IsExactForIntegerShapes) {
  for (const int a : {1, 2, 5, 30}) {
    // An x whose score is near the parameter: Q = e^-x to first order.
    const double x = GetParam() * std::numbers::ln10 + a - 1;
    const double expected = log_tail_of_integer_shape(a, x);
    EXPECT_NEAR(log_gamma_upper_tail(a, x) / expected, 1, 1e-10) << "a = " << a << ", x = " << x;
  }
}

TEST_P(GammaTailAtScore, IsTheComplementaryErrorFunctionForShapeOneHalf) {
  const double x = GetParam() * std::numbers::ln10;
  // Q(1/2, x) = erfc(sqrt x); beyond 300 nats its asymptotic series.
  const double expected =
      x < 300 ? std::log(std::erfc(std::sqrt(x)))
              : -x - 0.5 * std::log(std::numbers::pi * x) +
                    std::log1p(-1 / (2 * x) + 3 / (4 * x * x) - 15 / (8 * x * x * x));
  EXPECT_NEAR(log_gamma_upper_tail(0.5, x) / expected, 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Scores, GammaTailAtScore, ::testing::Values(0.3, 3.0, 30.0, 150.0));

TEST(GammaTail, IsCertainAtZeroAndContinuousAtTheChangeOfExpansion) {
  EXPECT_EQ(log_gamma_upper_tail(0.5, 0), 0);
  for (const double a : {0.3, 1.0, 7.5, 80.0}) {
    const double below = log_gamma_upper_tail(a, (a + 1) * (1 - 1e-12));
    const double above = log_gamma_upper_tail(a, (a + 1) * (1 + 1e-12));
    EXPECT_NEAR(below, above, 1e-9);
  }
}

}  // namespace
}  // namespace tribench
