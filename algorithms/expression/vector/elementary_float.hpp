// SPDX-License-Identifier: MIT
//
// exp, log, sin, cos, tanh, atan and pow of a vector of floats: at most 2 ulp, special points and
// bits as in foundation/elementary/functions.hpp, whose methods these are with shorter polynomials.
// Angles beyond kLargeAngleF are reduced in double.
#pragma once

#include "foundation/elementary/functions.hpp"
#include "foundation/elementary/power.hpp"

namespace tribench {
namespace {

constexpr float kRounderF = 0x1.8p23F;
constexpr float kLog2EF = 0x1.715476p+0F;
constexpr float kLn2HighF = 0x1.62e430p-1F;
constexpr float kLn2LowF = -0x1.05c610p-29F;

inline F32 exp_tail(F32 r) {
  constexpr float kQ[] = {0x1.fffffcp-2F, 0x1.555492p-3F, 0x1.5558f4p-5F, 0x1.123a22p-7F,
                          0x1.6a2378p-10F};
  return polynomial(r, kQ);
}

inline F32 power_of_two(F32 rounded) {  // 2^n from n + kRounderF, -126 <= n <= 127
  return from_bits((bits(rounded) << 23) + 0x3f800000);
}

inline F32 scale(F32 y, F32 n) {
#if TRIBENCH_LANE_BYTES == 64
  return _mm512_maskz_scalef_ps(0xffff, y, n);
#else
  const F32 half = fma(n, splat(0.5F), splat(kRounderF));
  const F32 rest = n - (half - kRounderF);
  return y * power_of_two(half) * power_of_two(rest + kRounderF);
#endif
}

inline F32 exp(F32 x) {
  const auto vanishes = x < -104.0F;
  const F32 y = vanishes ? F32{} : min(89.0F, x);
  const F32 n = fma(y, splat(kLog2EF), splat(kRounderF)) - kRounderF;
  F32 r = fma(n, splat(-kLn2HighF), y);
  r = fma(n, splat(-kLn2LowF), r);
  return vanishes ? F32{} : scale(1.0F + fma(r * r, exp_tail(r), r), n);
}

inline F32 log(F32 x) {
  constexpr float kP[] = {0x1.555554p-2F, -0x1.000226p-2F, 0x1.99a008p-3F, -0x1.547246p-3F,
                          0x1.22da1ep-3F, -0x1.0d853ep-3F, 0x1.055b82p-3F, -0x1.38b5f0p-4F};
  constexpr float kSmallestNormal = 0x1p-126F;
  constexpr float kInfinity = __builtin_inff();
  const bool unusual = any_outside(x, kSmallestNormal, kInfinity);
  F32 normal = x;
  F32 shift = splat(0.0F);
  if (unusual) [[unlikely]] {
    normal = x < kSmallestNormal ? x * 0x1p25F : x;
    shift = x < kSmallestNormal ? splat(25.0F) : shift;
  }
  constexpr std::uint32_t kHalfRoot = 0x3f3504f3;
  const U32 moved = bits(normal) + (0x3f800000 - kHalfRoot);
  const F32 k = __builtin_convertvector((I32)(moved >> 23) - 127, F32) - shift;
  const F32 f = from_bits((moved & 0x007fffff) + kHalfRoot) - 1.0F;
  const F32 f2 = f * f;
  F32 small = fma(f2 * f, polynomial(f, kP), k * kLn2LowF);
  small = fma(f2, splat(-0.5F), small);
  F32 result = fma(k, splat(kLn2HighF), f + small);
  if (unusual) [[unlikely]] {
    result = x == kInfinity ? x : result;
    result = x == 0.0F ? splat(-kInfinity) : result;
    result = x >= 0.0F ? result : splat(__builtin_nanf(""));
  }
  return result;
}

// Beyond it the quotient x / pi no longer rounds to the right integer within a thousandth.
constexpr float kLargeAngleF = 0x1p13F;
// Up to here two parts of pi in double leave a remainder that is right to a float; beyond, the
// double functions do it.
constexpr float kHugeAngleF = 0x1p40F;

// f of each half in double, a float again.
template <typename F>
inline F32 through_double(F f, F32 x) {
  using Half = float __attribute__((vector_size(kLaneBytes / 2)));
  Half low;
  Half high;
  __builtin_memcpy(&low, &x, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const char*>(&x) + sizeof low, sizeof high);
  const Half first = __builtin_convertvector(f(__builtin_convertvector(low, F64)), Half);
  const Half second = __builtin_convertvector(f(__builtin_convertvector(high, F64)), Half);
  F32 result;
  __builtin_memcpy(&result, &first, sizeof first);
  __builtin_memcpy(reinterpret_cast<char*>(&result) + sizeof first, &second, sizeof second);
  return result;
}

// x - n pi (sin) or x - (n + 1/2) pi (cos) in [-pi/2, pi/2], its sign turned where n is odd.
template <bool HalfTurn>
inline F32 signed_remainder(F32 x) {
  return through_double(
      [](F64 v) {
        F64 q = fma(v, splat(0x1.45f306dc9c883p-2), splat(HalfTurn ? -0.5 : 0.0)) + kRounder;
        const U64 turns = HalfTurn ? ~bits(q) : bits(q);
        q = q - kRounder + (HalfTurn ? 0.5 : 0.0);
        const F64 r = fma(q, splat(-0x1.921fb54442d18p+1), v);
        return from_bits(bits(fma(q, splat(-0x1.1a62633145c07p-53), r)) ^ (turns << 63));
      },
      x);
}

inline F32 sine_of_reduced(F32 r) {
  constexpr float kS[] = {-0x1.555556p-3F, 0x1.11110cp-7F, -0x1.a017d6p-13F, 0x1.717010p-19F,
                          -0x1.96p-26F};
  return sine_series(r, kS);
}

// result, with the lanes beyond kLargeAngleF replaced.
template <bool HalfTurn>
inline F32 with_large_angles(F32 x, F32 result) {
  const F32 size = abs(x);
  const F32 large = sine_of_reduced(signed_remainder<HalfTurn>(x));
  result = size > kLargeAngleF ? large : result;
  if (!any_finite_above(size, kHugeAngleF)) [[likely]]
    return result;
  const F32 huge = through_double([](F64 v) { return HalfTurn ? cos(v) : sin(v); }, x);
  return size > kHugeAngleF ? huge : result;
}

inline F32 sin(F32 x) {
  const F32 rounded = fma(x, splat(0x1.45f306p-2F), splat(kRounderF));
  const F32 n = rounded - kRounderF;
  F32 r = fma(n, splat(-0x1.921fb6p+1F), x);
  r = fma(n, splat(0x1.777a5cp-24F), r);
  r = fma(n, splat(0x1.ee59dap-49F), r);
  const F32 y = x == 0.0F ? x : sine_of_reduced(r);
  const F32 result = from_bits(bits(y) ^ (bits(rounded) << 31));
  if (!any_finite_above(abs(x), kLargeAngleF)) [[likely]]
    return result;
  return with_large_angles<false>(x, result);
}

inline F32 cos(F32 x) {
  const F32 size = abs(x);
  const F32 rounded = fma(size, splat(0x1.45f306p-2F), splat(-0.5F)) + kRounderF;
  const F32 n = rounded - kRounderF;
  const F32 q = fma(n, splat(2.0F), splat(1.0F));
  F32 r = fma(q, splat(-0x1.921fb6p+0F), size);
  r = fma(q, splat(0x1.777a5cp-25F), r);
  r = fma(q, splat(0x1.ee59dap-50F), r);
  const F32 result = from_bits(bits(sine_of_reduced(r)) ^ (~bits(rounded) << 31));
  if (!any_finite_above(size, kLargeAngleF)) [[likely]]
    return result;
  return with_large_angles<true>(size, result);
}

inline F32 tanh(F32 x) {
  const F32 y = min(20.0F, abs(x) * 2.0F);  // tanh is 1 from 9.1 on
  const F32 rounded = fma(y, splat(kLog2EF), splat(kRounderF));
  const F32 n = rounded - kRounderF;
  F32 r = fma(n, splat(-kLn2HighF), y);
  r = fma(n, splat(-kLn2LowF), r);
  const F32 two_n = power_of_two(rounded);
  const F32 curved = r * r * exp_tail(r);
  const F32 p = r + curved;
  const F32 p_rest = (r - p) + curved;
  const F32 above = two_n - 1.0F;
  const F32 scaled = two_n * p;
  const F32 t = above + scaled;
  const F32 t_rest = fma(two_n, p_rest, n > 0.0F ? (above - t) + scaled : splat(0.0F));
  const F32 d = t + 2.0F;
  const F32 d_rest = t > 2.0F ? 2.0F - (d - t) : t - (d - 2.0F);
  const F32 inverse = 1.0F / d;
  const F32 q = t * inverse;
  const F32 miss = fma(-q, d, t) + fma(-q, d_rest + t_rest, t_rest);
  return with_sign(fma(miss, inverse, q), x);
}

// In double, rounded once more: what is left out of a float's range has no float either.
template <typename Function, typename... Arguments>
inline F32 in_double(Function function, const Arguments&... arguments) {
  using Half = float __attribute__((vector_size(kLaneBytes / 2)));
  constexpr std::size_t kHalf = sizeof(Half);
  F32 result;
  for (std::size_t part = 0; part < 2; ++part) {
    const auto wide = [part](const F32& v) {
      return __builtin_convertvector(load<Half>(reinterpret_cast<const char*>(&v) + part * kHalf),
                                     F64);
    };
    store(reinterpret_cast<char*>(&result) + part * kHalf,
          __builtin_convertvector(function(wide(arguments)...), Half));
  }
  return result;
}

inline F32 pow(F32 x, F32 y) {
  return in_double([](F64 a, F64 b) { return pow(a, b); }, x, y);
}

inline F32 atan(F32 x) {
  return in_double([](F64 a) { return atan(a); }, x);
}

}  // namespace
}  // namespace tribench
