// SPDX-License-Identifier: MIT
//
// x^y of vectors of doubles: at most 1 ulp from the true value over the whole range (measured
// against MPFR by tests/.../elementary_test.cpp), the special cases of IEEE 754-2019, section 9.2.1
// (pow), and the same bits in every vector width.
//
// Method: log x as a sum of two doubles, to 2^-64 of itself, by 2 atanh((m - 1) / (m + 1)) without
// tables (the quotient, its square and the first coefficient in two doubles, the rest of the series
// in one); the product with y in two doubles; exp of that. Two divisions.
#pragma once

#include "foundation/elementary/functions.hpp"

namespace tribench {
namespace {

struct F64Pair {  // the unevaluated sum of both
  F64 high;
  F64 low;
};

// log of normal positive x 2^-shifted: k ln 2 + 2 atanh(s), s = (m - 1) / (m + 1).
inline F64Pair log_pair(F64 normal, F64 shift) {
  // atanh(s) / s = 1 + s^2 / 3 + s^4 (1/5 + s^2 / 7 + ...); |s| < 0.1716, left out: 2^-67.
  constexpr double kThird = 0x1.5555555555555p-2;
  constexpr double kThirdLow = 0x1.5555555555555p-56;
  constexpr double kTail[] = {1. / 5,  1. / 7,  1. / 9,  1. / 11, 1. / 13, 1. / 15,
                              1. / 17, 1. / 19, 1. / 21, 1. / 23, 1. / 25};
  constexpr double kLn2Short = 0x1.62e42fefa38p-1;  // 42 bits: k times it is exact
  constexpr double kLn2Rest = 0x1.ef35793c7673p-45;
  constexpr std::uint64_t kHalfRoot = 0x3fe6a09e667f3bcd;
  const U64 moved = bits(normal) + (0x3ff0000000000000 - kHalfRoot);
  const F64 k = from_bits((moved >> 52) | 0x4330000000000000) - (0x1p52 + 1023) - shift;
  const F64 f = from_bits((moved & 0x000fffffffffffff) + kHalfRoot) - 1.0;

  const F64 d = f + 2.0;
  const F64 inverse = 1.0 / d;
  const F64 s = f * inverse;
  const F64 s_rest = (fma(-s, d, f) - s * (f - (d - 2.0))) * inverse;
  const F64 z = s * s;
  const F64 z_rest = fma(s, s, -z) + 2.0 * s * s_rest;
  const F64 first = z * kThird;
  const F64 first_rest = fma(z, splat(kThird), -first) + fma(z_rest, splat(kThird), z * kThirdLow);
  const F64 tail = z * z * polynomial(z, kTail);
  const F64 p = first + tail;
  const F64 p_rest = ((first - p) + tail) + first_rest;

  const F64 twice = 2.0 * s;
  const F64 bent = twice * p;
  const F64 bent_rest = fma(twice, p, -bent) + fma(twice, p_rest, 2.0 * s_rest * p);
  const F64 sum = twice + bent;
  const F64 sum_rest = ((twice - sum) + bent) + (bent_rest + 2.0 * s_rest);
  const F64 whole = k * kLn2Short;
  const F64 total = whole + sum;
  const F64 rest = ((whole - total) + sum) + fma(k, splat(kLn2Rest), sum_rest);
  const F64 high = total + rest;
  return {high, (total - high) + rest};
}

// e^(high + low); low is at most an ulp of high.
inline F64 exp_pair(F64 high, F64 low) {
  const auto vanishes = high < -745.2;
  const auto overflows = high > 710.5;
  const F64 x = vanishes ? F64{} : (overflows ? splat(710.5) : high);
  const F64 x_low = vanishes | overflows ? F64{} : low;
  const F64 n = fma(x, splat(kLog2E), splat(kRounder)) - kRounder;
  const F64 r = fma(n, splat(-kLn2High), x);
  const F64 r_low = fma(n, splat(-kLn2Low), x_low);
  const F64 t = r + r_low;
  const F64 bent = fma(t * t, exp_tail(t), r_low);
  const F64 head = 1.0 + r;  // with what it loses: powers that are whole numbers come out whole
  return vanishes ? F64{} : scale(head + (((1.0 - head) + r) + bent), n);
}

// What the formula in logarithms cannot say. `magnitude` is |x|^y by it.
inline double unusual_power(double x, double y, double magnitude) {
  constexpr double kInfinity = __builtin_inf();
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return __builtin_nan("");
  const double size = x < 0 ? -x : x;
  const double reach = y < 0 ? -y : y;
  if (reach == kInfinity) return size == 1 ? 1 : ((size > 1) == (y > 0) ? kInfinity : 0);
  const bool is_whole = reach >= 0x1p53 || static_cast<double>(static_cast<std::int64_t>(y)) == y;
  const bool is_odd = is_whole && reach < 0x1p53 && (static_cast<std::int64_t>(y) & 1) != 0;
  std::uint64_t pattern = 0;
  __builtin_memcpy(&pattern, &x, sizeof pattern);
  const bool is_negative = (pattern >> 63) != 0;
  if (size == 0) magnitude = y > 0 ? 0 : kInfinity;
  if (size == kInfinity) magnitude = y > 0 ? kInfinity : 0;
  if (is_negative && !is_whole && size > 0 && size < kInfinity) return __builtin_nan("");
  return is_negative && is_odd ? -magnitude : magnitude;
}

inline F64 pow(F64 x, F64 y) {
  constexpr double kSmallestNormal = 0x1p-1022;
  constexpr double kInfinity = __builtin_inf();
  const F64 size = abs(x);
  const bool unusual = any_outside(x, kSmallestNormal, kInfinity) |
                       any_outside(y, -0x1.fffffffffffffp1023, kInfinity);
  F64 normal = size;
  F64 shift{};
  if (unusual) [[unlikely]] {
    normal = size < kSmallestNormal ? size * 0x1p54 : size;
    shift = size < kSmallestNormal ? splat(54.0) : shift;
  }
  const F64Pair logarithm = log_pair(normal, shift);
  const F64 high = y * logarithm.high;
  const F64 low = fma(y, logarithm.high, -high) + y * logarithm.low;
  F64 result = exp_pair(high, low);
  if (unusual) [[unlikely]] {
    for (std::size_t i = 0; i < kWidth<double>; ++i) {
      const bool is_usual = x[i] >= kSmallestNormal && x[i] < kInfinity && y[i] - y[i] == 0;
      if (!is_usual) result[i] = unusual_power(x[i], y[i], result[i]);
    }
  }
  return result;
}

}  // namespace
}  // namespace tribench
