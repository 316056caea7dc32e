// SPDX-License-Identifier: MIT
//
// C code of e^x in both precisions, for exported states; $N stands for the prefix of their names.
// Internal to the room.
#pragma once

#include <string_view>

namespace tribench {

// e^x, the bits of foundation/elementary: Cody and Waite's reduction, a minimax polynomial. Where
// 2^n is a normal number one factor gives the bits of the two: a step of LuGre takes a seventh
// less.
inline constexpr std::string_view kDoubleExp = R"(static inline double $Npower(double n) {
  uint64_t bits;
  double power;
  memcpy(&bits, &n, sizeof bits);
  bits = (bits << 52) + UINT64_C(0x3ff0000000000000);
  memcpy(&power, &bits, sizeof power);
  return power;
}

/* e^y over a power of two, whose exponent is *exponent. */
static inline double $Nreduced_exp(double y, double *exponent) {
  const double round = 0x1.8p52;
  double n, r, r2, even, odd;
  n = fma(y, 0x1.71547652b82fep+0, round) - round;
  r = fma(n, -0x1.62e42fefa39efp-1, y);
  r = fma(n, -0x1.abc9e3b39803fp-56, r);
  r2 = r * r;
  even = 0x1.28ad9b9828b5bp-22;
  odd = 0x1.ad7f035685223p-26;
  even = fma(even, r2, 0x1.a01999e263a8cp-16);
  even = fma(even, r2, 0x1.6c16c18438a60p-10);
  even = fma(even, r2, 0x1.555555555083fp-5);
  even = fma(even, r2, 0x1.000000000000ap-1);
  odd = fma(odd, r2, 0x1.71df25da29fd6p-19);
  odd = fma(odd, r2, 0x1.a01a0129fd31ep-13);
  odd = fma(odd, r2, 0x1.1111111127d44p-7);
  odd = fma(odd, r2, 0x1.55555555554f9p-3);
  *exponent = n;
  return 1.0 + fma(r2, fma(odd, r, even), r);
}

/* e^x within 2 units in the last place, the same bits on every machine. */
static inline double $Nexp(double x) {
  const double round = 0x1.8p52;
  double n, y, half;
  if (x >= -708.0 && x <= 709.0) {
    y = $Nreduced_exp(x, &n);
    return y * $Npower(n + round);
  }
  if (x < -745.2) return 0.0;
  y = $Nreduced_exp(x > 710.5 ? 710.5 : x, &n);
  half = fma(n, 0.5, round);
  return y * $Npower(half) * $Npower(n - (half - round) + round);
}

)";

inline constexpr std::string_view kFloatExp = R"(static inline float $Npower(float n) {
  uint32_t bits;
  float power;
  memcpy(&bits, &n, sizeof bits);
  bits = (bits << 23) + UINT32_C(0x3f800000);
  memcpy(&power, &bits, sizeof power);
  return power;
}

/* e^y over a power of two, whose exponent is *exponent. */
static inline float $Nreduced_exp(float y, float *exponent) {
  const float round = 0x1.8p23F;
  float n, r, r2, even, odd;
  n = fmaf(y, 0x1.715476p+0F, round) - round;
  r = fmaf(n, -0x1.62e430p-1F, y);
  r = fmaf(n, 0x1.05c610p-29F, r);
  r2 = r * r;
  even = 0x1.6a2378p-10F;
  odd = 0x1.123a22p-7F;
  even = fmaf(even, r2, 0x1.5558f4p-5F);
  even = fmaf(even, r2, 0x1.fffffcp-2F);
  odd = fmaf(odd, r2, 0x1.555492p-3F);
  *exponent = n;
  return 1.0F + fmaf(r2, fmaf(odd, r, even), r);
}

/* e^x within 2 units in the last place, the same bits on every machine. */
static inline float $Nexp(float x) {
  const float round = 0x1.8p23F;
  float n, y, half;
  if (x >= -87.0F && x <= 88.0F) {
    y = $Nreduced_exp(x, &n);
    return y * $Npower(n + round);
  }
  if (x < -104.0F) return 0.0F;
  y = $Nreduced_exp(x > 89.0F ? 89.0F : x, &n);
  half = fmaf(n, 0.5F, round);
  return y * $Npower(half) * $Npower(n - (half - round) + round);
}

)";

}  // namespace tribench
