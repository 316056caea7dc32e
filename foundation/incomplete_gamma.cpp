// SPDX-License-Identifier: MIT
#include "foundation/incomplete_gamma.hpp"

#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr int kMaxTerms = 10000;
constexpr double kTolerance = 1e-14;

// log of x^a e^-x / Gamma(a), the factor both expansions share.
double log_prefactor(double a, double x) {
  return a * elementary::log(x) - x - elementary::lgamma(a);
}

// P(a, x) by its power series; for x < a + 1.
double lower_tail_series(double a, double x) {
  double term = 1 / a;
  double sum = term;
  for (int n = 1; n < kMaxTerms; ++n) {
    term *= x / (a + n);
    sum += term;
    if (term < kTolerance * sum) break;
  }
  return sum * elementary::exp(log_prefactor(a, x));
}

// log Q(a, x) by Lentz's continued fraction; for x >= a + 1.
double log_upper_tail_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double h = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    const double factor = d * c;
    h *= factor;
    if (std::abs(factor - 1) < kTolerance) break;
  }
  return log_prefactor(a, x) + elementary::log(h);
}

}  // namespace

double log_gamma_upper_tail(double a, double x) {
  if (!(x > 0)) return 0;
  if (std::isinf(x)) return -std::numeric_limits<double>::infinity();
  if (x < a + 1) return elementary::log1p(-lower_tail_series(a, x));
  return log_upper_tail_fraction(a, x);
}

}  // namespace tribench
