// SPDX-License-Identifier: MIT
#include "foundation/elementary.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/elementary/column.hpp"
#include "foundation/elementary/scalar.hpp"

namespace tribench::elementary {
namespace {

// The same bits on every processor, by the widest instructions that it has.
struct Tables {
  const ScalarTable& scalar;
  const ColumnTable& column;
};

const Tables& tables() {
#if defined(__x86_64__)
  static const Tables chosen = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
                                   ? Tables{kScalarFma, kColumnFma}
                                   : Tables{kScalarBaseline, kColumnBaseline};
#else
  static constexpr Tables chosen{kScalarBaseline, kColumnBaseline};
#endif
  return chosen;
}

}  // namespace

double exp(double x) { return tables().scalar.exp(x); }
double log(double x) { return tables().scalar.log(x); }
double sin(double x) { return tables().scalar.sin(x); }
double cos(double x) { return tables().scalar.cos(x); }
double tanh(double x) { return tables().scalar.tanh(x); }
double atan(double x) { return tables().scalar.atan(x); }
double pow(double x, double y) { return tables().scalar.pow(x, y); }

void exp_of_each(std::span<double> x) { tables().column.exp(x.data(), x.size()); }
void sin_of_each(std::span<double> x) { tables().column.sin(x.data(), x.size()); }
void cos_of_each(std::span<double> x) { tables().column.cos(x.data(), x.size()); }
void tanh_of_each(std::span<double> x) { tables().column.tanh(x.data(), x.size()); }
void pow_of_each(std::span<double> x, double y) { tables().column.pow(x.data(), x.size(), y); }

// Kahan: what rounding took from 1 + x is made good by the ratio.
double log1p(double x) {
  const double sum = 1 + x;
  if (sum == 1 || sum == std::numeric_limits<double>::infinity()) return x;
  return log(sum) * (x / (sum - 1));
}

double expm1(double x) {
  const double power = exp(x);
  if (power == 1) return x;
  if (power == 0 || std::isinf(power)) return power - 1;
  return (power - 1) * (x / log(power));
}

double atanh(double x) {
  const double size = std::abs(x);
  return std::copysign(0.5 * log1p(2 * size / (1 - size)), x);
}

double log10(double x) {
  const double value = log(x) * std::numbers::log10e;
  const double nearest = std::nearbyint(value);
  const bool is_near = std::abs(value - nearest) < 1e-12 && std::abs(nearest) <= 22;
  return is_near && pow(10, nearest) == x ? nearest : value;
}

double tan(double x) { return sin(x) / cos(x); }
double sinh(double x) { return (exp(x) - exp(-x)) / 2; }
double cosh(double x) { return (exp(x) + exp(-x)) / 2; }

double lgamma(double x) {
  constexpr double kStart = 10;
  constexpr double kHalfLogTwoPi = 0.91893853320467274178;
  constexpr double kSeries[] = {1. / 12,   -1. / 360,      1. / 1260, -1. / 1680,
                                1. / 1188, -691. / 360360, 1. / 156,  -3617. / 122400};
  if (!(x > 0)) return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(x)) return x;
  double product = 1;
  double y = x;
  for (; y < kStart; ++y) product *= y;
  const double z = 1 / (y * y);
  double sum = 0;
  for (int i = 7; i >= 0; --i) sum = sum * z + kSeries[i];
  return (y - 0.5) * log(y) - y + kHalfLogTwoPi + sum / y - log(product);
}

}  // namespace tribench::elementary
