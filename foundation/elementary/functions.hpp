// SPDX-License-Identifier: MIT
//
// exp, log, sin, cos, tanh and atan of a vector of doubles: at most 2 ulp from the true value over
// the whole range (measured against MPFR by tests/.../elementary_test.cpp, which has the figures),
// exact at the special points (signed zeros, infinities, NaN, overflow, subnormals), and the same
// bits in every vector width: only operations that IEEE 754 defines, fused where written.
//
// Method: Cody-Waite reduction with fused multiply-add (its first step is exact), one minimax
// polynomial a function (Remez; weight = relative error of the result), Payne-Hanek reduction in
// integers for large arguments of sin and cos. No tables, no division except in tanh and atan.
#pragma once

#include "foundation/elementary/lanes.hpp"

namespace tribench {
namespace {

// Adding it to |x| < 2^51 leaves the nearest integer in the low bits.
constexpr double kRounder = 0x1.8p52;
constexpr double kLog2E = 0x1.71547652b82fep+0;
constexpr double kLn2High = 0x1.62e42fefa39efp-1;
constexpr double kLn2Low = 0x1.abc9e3b39803fp-56;

// sum_i c[i] x^i with even and odd terms in two chains.
template <typename V, typename T, int N>
inline V polynomial(V x, const T (&c)[N]) {
  const V x2 = x * x;
  V even = splat(c[(N - 1) & ~1]);
  V odd = splat(c[(N - 2) | 1]);
  for (int i = ((N - 1) & ~1) - 2; i >= 0; i -= 2) even = fma(even, x2, splat(c[i]));
  for (int i = ((N - 2) | 1) - 2; i >= 1; i -= 2) odd = fma(odd, x2, splat(c[i]));
  return fma(odd, x, even);
}

// e^r - 1 for |r| <= ln 2 / 2, divided as r + r^2 q(r); q to 2^-58 of e^r (2^-62 of e^r - 1).
inline F64 exp_tail(F64 r) {
  constexpr double kQ[] = {0x1.0000000000000p-1,  0x1.5555555555559p-3,  0x1.555555555553ep-5,
                           0x1.111111110f6c5p-7,  0x1.6c16c16c1f0f3p-10, 0x1.a01a01afdd827p-13,
                           0x1.a01a017bab53cp-16, 0x1.71ddf863d82aep-19, 0x1.27e5364e3c54ep-22,
                           0x1.af5ea8190f107p-26, 0x1.1ee8785a734a5p-29};
  return polynomial(r, kQ);
}

inline F64 power_of_two(F64 rounded) {  // 2^n from n + kRounder, -1022 <= n <= 1023
  return from_bits((bits(rounded) << 52) + 0x3ff0000000000000);
}

// y 2^n for any n of exp's range, rounded once.
inline F64 scale(F64 y, F64 n) {
#if TRIBENCH_LANE_BYTES == 64
  return _mm512_maskz_scalef_pd(0xff, y, n);
#else
  const F64 half = fma(n, splat(0.5), splat(kRounder));
  const F64 rest = n - (half - kRounder);
  return y * power_of_two(half) * power_of_two(rest + kRounder);
#endif
}

inline F64 exp(F64 x) {
  constexpr double kQ[] = {0x1.000000000000ap-1,  0x1.55555555554f9p-3,  0x1.555555555083fp-5,
                           0x1.1111111127d44p-7,  0x1.6c16c18438a60p-10, 0x1.a01a0129fd31ep-13,
                           0x1.a01999e263a8cp-16, 0x1.71df25da29fd6p-19, 0x1.28ad9b9828b5bp-22,
                           0x1.ad7f035685223p-26};
  // Above 710.5 the result is infinite, by the scaling alone. Below -745.2 it is 0, by selection:
  // processors take 20 times as long for a product that underflows.
  const auto vanishes = x < -745.2;
  const F64 y = vanishes ? F64{} : min(710.5, x);
  const F64 n = fma(y, splat(kLog2E), splat(kRounder)) - kRounder;
  F64 r = fma(n, splat(-kLn2High), y);
  r = fma(n, splat(-kLn2Low), r);
  return vanishes ? F64{} : scale(1.0 + fma(r * r, polynomial(r, kQ), r), n);
}

inline F64 log(F64 x) {
  constexpr double kP[] = {
      0x1.5555555555533p-2, -0x1.fffffffffef13p-3, 0x1.999999999f755p-3, -0x1.555555566b3ffp-3,
      0x1.24924922a40a6p-3, -0x1.ffffff2bf1861p-4, 0x1.c71c71dffa3e8p-4, -0x1.9999c26be529dp-4,
      0x1.745d3f20fd90bp-4, -0x1.5550ee6b3c4c1p-4, 0x1.3b0b88c1d5254p-4, -0x1.24d74ec86d5bep-4,
      0x1.11cd03fd8bde8p-4, -0x1.fba1c99369749p-5, 0x1.d05a4443d8140p-5, -0x1.d11f697364bbdp-5,
      0x1.0a62474679f82p-4, -0x1.ea06ccd86a2e1p-5, 0x1.ac76b0e58e76fp-6};
  constexpr double kSmallestNormal = 0x1p-1022;
  constexpr double kInfinity = __builtin_inf();
  const bool unusual = any_outside(x, kSmallestNormal, kInfinity);
  F64 normal = x;
  F64 shift = splat(0x1p52 + 1023);
  if (unusual) [[unlikely]] {
    normal = x < kSmallestNormal ? x * 0x1p54 : x;
    shift = x < kSmallestNormal ? splat(0x1p52 + 1023 + 54) : shift;
  }
  // x = 2^k (1 + f), 1 + f in [sqrt(1/2), sqrt(2)).
  constexpr std::uint64_t kHalfRoot = 0x3fe6a09e667f3bcd;
  const U64 moved = bits(normal) + (0x3ff0000000000000 - kHalfRoot);
  const F64 k = from_bits((moved >> 52) | 0x4330000000000000) - shift;
  const F64 f = from_bits((moved & 0x000fffffffffffff) + kHalfRoot) - 1.0;
  const F64 f2 = f * f;
  F64 small = fma(f2 * f, polynomial(f, kP), k * kLn2Low);
  small = fma(f2, splat(-0.5), small);
  F64 result = fma(k, splat(kLn2High), f + small);
  if (unusual) [[unlikely]] {
    result = x == kInfinity ? x : result;
    result = x == 0.0 ? splat(-kInfinity) : result;
    result = x >= 0.0 ? result : splat(__builtin_nan(""));
  }
  return result;
}

// Up to here the three-part reduction keeps 2 ulp; the last part left out is n 2^-163.
constexpr double kLargeAngle = 0x1p22;

__extension__ using Wide = unsigned __int128;
__extension__ using SignedWide = __int128;

struct Reduced {
  double rest;          // in [-pi/2, pi/2]
  std::uint64_t turns;  // |x| = turns pi + rest (sin), (turns + 1/2) pi + rest (cos)
};

// Payne and Hanek 1983: only the bits of 1/pi that decide the fraction of x / pi are multiplied.
// magnitude is finite and at least kLargeAngle. half_turn: reduce x - pi/2 instead.
inline Reduced reduce_large_angle(double magnitude, bool half_turn) {
  static constexpr std::uint64_t kInversePi[] = {0,  // guard: bits in front of the point
                                                 0x517cc1b727220a94,
                                                 0xfe13abe8fa9a6ee0,
                                                 0x6db14acc9e21c820,
                                                 0xff28b1d5ef5de2b0,
                                                 0xdb92371d2126e970,
                                                 0x0324977504e8c90e,
                                                 0x7f0ef58e5894d39f,
                                                 0x74411afa975da242,
                                                 0x74ce38135a2fbf20,
                                                 0x9cc8eb1cc1a99cfa,
                                                 0x4e422fc5defc941d,
                                                 0x8ffc4bffef02cc07,
                                                 0xf79788c5ad05368f,
                                                 0xb69b3f6793e584db,
                                                 0xa7a31fb34f2ff516,
                                                 0xba93dd63f5f2f8bd,
                                                 0x9e839cfbc5294975,
                                                 0x35fdafd88fc6ae84,
                                                 0x2b0198237e3db5d5};
  std::uint64_t pattern = 0;
  __builtin_memcpy(&pattern, &magnitude, sizeof pattern);
  const int exponent = static_cast<int>(pattern >> 52) - 1075;  // magnitude = mantissa 2^exponent
  const std::uint64_t mantissa = (pattern & 0x000fffffffffffff) | 0x0010000000000000;
  // Window of 192 bits of 1/pi that starts 2 bits above the point of 2^exponent / pi; what lies
  // further up contributes multiples of 4 mantissa.
  const int start = 64 + exponent - 2;
  std::uint64_t window[3];
  for (int i = 0; i < 3; ++i) {
    const int word = start / 64 + i;
    const int shift = start % 64;
    window[i] = kInversePi[word] << shift;
    if (shift != 0) window[i] |= kInversePi[word + 1] >> (64 - shift);
  }
  const Wide low = static_cast<Wide>(mantissa) * window[2];
  const Wide middle =
      static_cast<Wide>(mantissa) * window[1] + static_cast<std::uint64_t>(low >> 64);
  const std::uint64_t high = mantissa * window[0] + static_cast<std::uint64_t>(middle >> 64);
  // x / pi mod 4 as 2 + 126 bits.
  Wide fraction = (static_cast<Wide>(high) << 64) | static_cast<std::uint64_t>(middle);
  if (half_turn) fraction -= static_cast<Wide>(1) << 125;
  const Wide nearest = (fraction + (static_cast<Wide>(1) << 125)) >> 126;
  const auto rest = static_cast<SignedWide>(fraction - (nearest << 126));
  const bool negative = rest < 0;
  const Wide size = static_cast<Wide>(negative ? -rest : rest);
  const auto size_high = static_cast<double>(static_cast<std::uint64_t>(size >> 64));
  const auto size_low = static_cast<double>(static_cast<std::uint64_t>(size));
  // Two words, the first rounded to 53 bits: the second carries what the rounding lost.
  const double head = (size_high + size_low * 0x1p-64) * 0x1p-62;
  const auto lost = static_cast<SignedWide>(size) - static_cast<SignedWide>(head * 0x1p126);
  const double tail = static_cast<double>(lost) * 0x1p-126;
  constexpr double kPi = 0x1.921fb54442d18p+1;
  constexpr double kPiLow = 0x1.1a62633145c07p-53;
  const double angle = head * kPi + (tail * kPi + head * kPiLow);
  return {negative ? -angle : angle, static_cast<std::uint64_t>(nearest & 3)};
}

// r + r^3 s(r^2), clamped to [-1, 1]; r^3 is rounded once.
template <typename V, typename T, int N>
inline V sine_series(V r, const T (&s)[N]) {
  const V z = r * r;
  const V z_rest = fma(r, r, -z);
  const V cube = fma(r, z, z_rest * r);
  return max(T{-1}, min(T{1}, fma(cube, polynomial(z, s), r)));
}

inline F64 sine_of_reduced(F64 r) {
  constexpr double kS[] = {-0x1.5555555555555p-3,  0x1.11111111110c0p-7,   -0x1.a01a01a0147a8p-13,
                           0x1.71de3a52802a6p-19,  -0x1.ae6454c7c515fp-26, 0x1.6123ca3e03861p-33,
                           -0x1.ae42df255ee5bp-41, 0x1.8822ee5060017p-49};
  return sine_series(r, kS);
}

inline void reduce_large_lanes(F64 x, bool half_turn, F64& r, U64& turns) {
  for (std::size_t i = 0; i < kWidth<double>; ++i) {
    const double magnitude = x[i] < 0 ? -x[i] : x[i];
    if (!(magnitude > kLargeAngle && magnitude < __builtin_inf())) continue;
    const Reduced reduced = reduce_large_angle(magnitude, half_turn);
    r[i] = reduced.rest;
    turns[i] = reduced.turns;
  }
}

inline F64 sin(F64 x) {
  const F64 rounded = fma(x, splat(0x1.45f306dc9c883p-2), splat(kRounder));
  const F64 n = rounded - kRounder;
  U64 turns = bits(rounded);
  F64 r = fma(n, splat(-0x1.921fb54442d18p+1), x);
  r = fma(n, splat(-0x1.1a62633145c07p-53), r);
  r = fma(n, splat(0x1.f1976b7ed8fbcp-109), r);
  if (any_finite_above(abs(x), kLargeAngle)) [[unlikely]] {
    reduce_large_lanes(x, false, r, turns);
    const U64 flip = (U64)(abs(x) > kLargeAngle) & bits(x) & kSignBit64;
    r = from_bits(bits(r) ^ flip);
  }
  const F64 y = x == 0.0 ? x : sine_of_reduced(r);  // the polynomial loses the sign of zero
  return from_bits(bits(y) ^ (turns << 63));
}

inline F64 cos(F64 x) {
  const F64 size = abs(x);
  const F64 rounded = fma(size, splat(0x1.45f306dc9c883p-2), splat(-0.5)) + kRounder;
  const F64 n = rounded - kRounder;
  const F64 q = fma(n, splat(2.0), splat(1.0));  // x = q pi/2 + r
  U64 turns = bits(rounded);
  F64 r = fma(q, splat(-0x1.921fb54442d18p+0), size);
  r = fma(q, splat(-0x1.1a62633145c07p-54), r);
  r = fma(q, splat(0x1.f1976b7ed8fbcp-110), r);
  if (any_finite_above(size, kLargeAngle)) [[unlikely]]
    reduce_large_lanes(x, true, r, turns);
  const F64 y = sine_of_reduced(r);
  return from_bits(bits(y) ^ (~turns << 63));
}

// (e^2x - 1) / (e^2x + 1), with the rounding errors of numerator and denominator carried along.
inline F64 tanh(F64 x) {
  const F64 y = min(44.0, abs(x) * 2.0);  // tanh is 1 from 19.1 on
  const F64 rounded = fma(y, splat(kLog2E), splat(kRounder));
  const F64 n = rounded - kRounder;
  F64 r = fma(n, splat(-kLn2High), y);
  r = fma(n, splat(-kLn2Low), r);
  const F64 two_n = power_of_two(rounded);
  const F64 curved = r * r * exp_tail(r);
  const F64 p = r + curved;
  const F64 p_rest = (r - p) + curved;
  const F64 above = two_n - 1.0;
  const F64 scaled = two_n * p;
  const F64 t = above + scaled;
  const F64 t_rest = fma(two_n, p_rest, n > 0.0 ? (above - t) + scaled : splat(0.0));
  const F64 d = t + 2.0;
  const F64 d_rest = t > 2.0 ? 2.0 - (d - t) : t - (d - 2.0);
  const F64 inverse = 1.0 / d;
  const F64 q = t * inverse;
  const F64 miss = fma(-q, d, t) + fma(-q, d_rest + t_rest, t_rest);
  return with_sign(fma(miss, inverse, q), x);
}

// Of |x| <= tan(pi/8) about, to which larger ones are brought: pi/4 + atan((x - 1) / (x + 1)),
// pi/2 - atan(1/x). Source of the ranges and of the ratio of polynomials: Moshier, Cephes, atan.c.
inline F64 atan(F64 x) {
  const F64 size = abs(x);
  const auto is_large = size > 2.414213562373095;
  const auto is_middle = size > 0.66;
  const F64 above = is_large ? splat(-1.0) : (is_middle ? size - 1.0 : size);
  const F64 below = is_large ? size : (is_middle ? size + 1.0 : splat(1.0));
  const F64 turn = is_large ? splat(0x1.921fb54442d18p+0)
                            : (is_middle ? splat(0x1.921fb54442d18p-1) : splat(0.0));
  const F64 turn_rest = is_large ? splat(0x1.1a62633145c07p-54)
                                 : (is_middle ? splat(0x1.1a62633145c07p-55) : splat(0.0));
  const F64 r = above / below;
  const F64 z = r * r;
  F64 p = fma(z, splat(-8.750608600031904122785e-1), splat(-1.615753718733365076637e1));
  p = fma(p, z, splat(-7.500855792314704667340e1));
  p = fma(p, z, splat(-1.228866684490136173410e2));
  p = fma(p, z, splat(-6.485021904942025371773e1));
  F64 q = z + 2.485846490142306297962e1;
  q = fma(q, z, splat(1.650270098316988542046e2));
  q = fma(q, z, splat(4.328810604912902668951e2));
  q = fma(q, z, splat(4.853903996359136964868e2));
  q = fma(q, z, splat(1.945506571482613964425e2));
  const F64 curved = fma(r, z * p / q, turn_rest);
  return with_sign(turn + (r + curved), x);
}

}  // namespace
}  // namespace tribench
