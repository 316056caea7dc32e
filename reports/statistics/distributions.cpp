// SPDX-License-Identifier: MIT
#include "reports/statistics/distributions.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace tribench {
namespace {

constexpr double kTiny = 1e-300;
constexpr int kMaxTerms = 10000;

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

double gamma_series(double a, double x) {
  double term = 1 / a;
  double sum = term;
  for (int n = 1; n < kMaxTerms && std::abs(term) > std::abs(sum) * 1e-17; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

// Lentz's method for the upper function.
double gamma_fraction(double a, double x) {
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double h = d;
  for (int i = 1; i < kMaxTerms; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-16) break;
  }
  return std::exp(-x + a * std::log(x) - std::lgamma(a)) * h;
}

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double p) {
  return root_of([p](double z) { return normal_cdf(z) - p; }, -40, 40);
}

double chi_squared_tail(double x, double degrees) {
  const double a = degrees / 2;
  const double half = x / 2;
  if (half <= 0) return 1;
  return half < a + 1 ? 1 - gamma_series(a, half) : gamma_fraction(a, half);
}

double normal_range_cdf(double q, int k) {
  // The smallest of the k lies at z, the others between z and z + q.
  if (q <= 0) return 0;
  constexpr int kSteps = 2000;
  constexpr double kReach = 8.5;
  const double step = (2 * kReach + q) / kSteps;
  const double start = -kReach - q;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = start + i * step;
    const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
    const double value = density * std::pow(normal_cdf(z + q) - normal_cdf(z), k - 1);
    sum += value * (i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2));
  }
  return k * sum * step / 3;
}

double normal_range_quantile(double p, int k) {
  return root_of([p, k](double q) { return normal_range_cdf(q, k) - p; }, 0, 40);
}

}  // namespace tribench
