// SPDX-License-Identifier: MIT
//
// Variable projection: least squares of sum_k c_k f_k(row; theta) where theta is searched for and
// the coefficients c, some of them held non-negative, are solved for exactly at every theta.
//
// For a handful of features and of parameters theta that can be bounded; features are columns that
// a model computes (states along a motion, shapes of a curve), not expressions: those have
// constant_fit.hpp. Starts are a grid of points, the best of them are walked down by
// Levenberg-Marquardt with Kaufman's Jacobian. Deterministic: no random numbers.
//
// Source: Golub & Pereyra 1973; Kaufman 1975.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribench {

class SeparableModel {
 public:
  virtual ~SeparableModel() = default;
  virtual std::size_t rows() const = 0;
  virtual std::size_t features() const = 0;
  virtual std::size_t parameters() const = 0;  // of theta
  // features[k * rows + r]. False where theta cannot be computed (a budget is spent).
  virtual bool evaluate(std::span<const double> theta, std::span<double> features) = 0;
  // slopes[(j * features + k) * rows + r]: of feature k by theta j.
  virtual bool differentiate(std::span<const double> theta, std::span<double> slopes) = 0;
};

struct SeparableOptions {
  std::vector<double> low;                  // of theta; finite
  std::vector<double> high;                 // of theta; finite
  std::vector<char> non_negative;           // of the coefficients
  std::vector<std::vector<double>> starts;  // points of theta, tried in this order
  std::size_t walked = 3;                   // so many of the best starts are walked down
  int max_iterations = 40;
};

struct SeparableFit {
  std::vector<double> theta;
  std::vector<double> coefficients;
  double sum_squares = 0;  // infinite where no start could be computed
};

// Features that are constant 0 get the coefficient 0. All targets must be finite.
SeparableFit fit_separable(SeparableModel& model, std::span<const double> target,
                           const SeparableOptions& options);

}  // namespace tribench
