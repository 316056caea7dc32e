// SPDX-License-Identifier: MIT
#include "algorithms/fitting/separable_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench {
namespace {

// Two decays and a constant: exp(-t / exp(theta_0)), exp(-t / exp(theta_1)), 1.
class Decays : public SeparableModel {
 public:
  std::size_t rows() const override { return 200; }
  std::size_t features() const override { return 3; }
  std::size_t parameters() const override { return 2; }
  static double time(std::size_t row) { return 0.05 * static_cast<double>(row); }

  bool evaluate(std::span<const double> theta, std::span<double> out) override {
    ++evaluations;
    for (std::size_t r = 0; r < rows(); ++r) {
      out[r] = std::exp(-time(r) / std::exp(theta[0]));
      out[rows() + r] = std::exp(-time(r) / std::exp(theta[1]));
      out[2 * rows() + r] = 1;
    }
    return evaluations <= allowed;
  }
  bool differentiate(std::span<const double> theta, std::span<double> slopes) override {
    std::fill(slopes.begin(), slopes.end(), 0.0);
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t r = 0; r < rows(); ++r) {
        const double x = time(r) / std::exp(theta[j]);
        slopes[(j * 3 + j) * rows() + r] = x * std::exp(-x);
      }
    }
    return true;
  }

  int evaluations = 0;
  int allowed = 1 << 30;
};

std::vector<double> planted(double a, double b) {
  std::vector<double> target;
  for (std::size_t r = 0; r < 200; ++r) {
    target.push_back(a * std::exp(-Decays::time(r) / 0.5) + b * std::exp(-Decays::time(r) / 4) + 1);
  }
  return target;
}

SeparableOptions options() {
  SeparableOptions options;
  options.low = {-5, -5};
  options.high = {5, 5};
  options.non_negative = {1, 1, 0};
  options.starts = {{-3, 3}, {0, 1}, {-1, 2}};
  return options;
}

TEST(SeparableFit, FindsWhatIsNotLinearAndSolvesForTheRest) {
  Decays model;
  const SeparableFit fit = fit_separable(model, planted(2, 3), options());
  EXPECT_LT(fit.sum_squares, 1e-16);
  EXPECT_NEAR(std::exp(fit.theta[0]), 0.5, 1e-6);
  EXPECT_NEAR(std::exp(fit.theta[1]), 4, 1e-6);
  EXPECT_NEAR(fit.coefficients[0], 2, 1e-6);
  EXPECT_NEAR(fit.coefficients[2], 1, 1e-6);
}

TEST(SeparableFit, HoldsCoefficientsNonNegative) {
  Decays model;
  const SeparableFit fit = fit_separable(model, planted(-2, 3), options());
  EXPECT_GE(fit.coefficients[0], 0);
  EXPECT_GE(fit.coefficients[1], 0);
  EXPECT_GT(fit.sum_squares, 1e-3);
}

TEST(SeparableFit, SaysWhereNoStartCanBeComputed) {
  Decays model;
  model.allowed = 0;
  EXPECT_TRUE(std::isinf(fit_separable(model, planted(2, 3), options()).sum_squares));
}

}  // namespace
}  // namespace tribench
