// SPDX-License-Identifier: MIT
#include "reports/statistics/distributions.hpp"

#include <cmath>
#include <numbers>

#include "foundation/elementary.hpp"
#include "foundation/incomplete_gamma.hpp"

namespace tribench {
namespace {

// Root of a continuous increasing function by bisection to the last bits.
template <typename F>
double root_of(F increasing, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (increasing(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

// The error function is the incomplete gamma function with a = 1/2.
double normal_cdf(double z) {
  const double tail = 0.5 * elementary::exp(log_gamma_upper_tail(0.5, z * z / 2));
  return z < 0 ? tail : 1 - tail;
}

double normal_quantile(double p) {
  return root_of([p](double z) { return normal_cdf(z) - p; }, -40, 40);
}

double chi_squared_tail(double x, double degrees) {
  return elementary::exp(log_gamma_upper_tail(degrees / 2, x / 2));
}

double normal_range_cdf(double q, int k) {
  // The smallest of the k lies at z, the others between z and z + q. What is smooth and vanishes at
  // both ends converges faster than any power of the step.
  if (q <= 0) return 0;
  constexpr double kStep = 0.1;
  constexpr double kReach = 8.5;
  const int steps = static_cast<int>((2 * kReach + q) / kStep);
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double z = i * kStep - kReach - q;
    const double density = elementary::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    sum += density * elementary::pow(normal_cdf(z + q) - normal_cdf(z), k - 1);
  }
  return k * sum * kStep;
}

double normal_range_quantile(double p, int k) {
  return root_of([p, k](double q) { return normal_range_cdf(q, k) - p; }, 0, 40);
}

}  // namespace tribench
