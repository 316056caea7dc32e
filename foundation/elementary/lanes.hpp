// SPDX-License-Identifier: MIT
//
// One vector register's worth of doubles or floats, in the width that the including translation
// unit is compiled for (TRIBENCH_LANE_BYTES: 16, 32 or 64). GCC vector extensions give arithmetic,
// comparison and selection; here stands what they lack. Everything is in an unnamed namespace: the
// same names mean other code in each translation unit.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tribench {
namespace {

constexpr int kLaneBytes = TRIBENCH_LANE_BYTES;

using F64 = double __attribute__((vector_size(kLaneBytes), may_alias));
using I64 = std::int64_t __attribute__((vector_size(kLaneBytes), may_alias));
using U64 = std::uint64_t __attribute__((vector_size(kLaneBytes), may_alias));
using F32 = float __attribute__((vector_size(kLaneBytes), may_alias));
using I32 = std::int32_t __attribute__((vector_size(kLaneBytes), may_alias));
using U32 = std::uint32_t __attribute__((vector_size(kLaneBytes), may_alias));

template <typename T>
struct Lanes;
template <>
struct Lanes<double> {
  using V = F64;
};
template <>
struct Lanes<float> {
  using V = F32;
};
template <typename T>
using Vector = typename Lanes<T>::V;
template <typename T>
constexpr std::size_t kWidth = kLaneBytes / sizeof(T);

// x - 0 keeps the sign of zero, unlike x + 0.
inline F64 splat(double x) { return x - F64{}; }
inline F32 splat(float x) { return x - F32{}; }

// Unsigned: sums of bit patterns wrap around.
inline U64 bits(F64 x) { return reinterpret_cast<U64&>(x); }
inline U32 bits(F32 x) { return reinterpret_cast<U32&>(x); }
inline F64 from_bits(U64 x) { return reinterpret_cast<F64&>(x); }
inline F32 from_bits(U32 x) { return reinterpret_cast<F32&>(x); }

constexpr std::uint64_t kSignBit64 = std::uint64_t{1} << 63;
constexpr std::uint32_t kSignBit32 = std::uint32_t{1} << 31;

template <typename V>
inline V load(const void* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <typename V>
inline void store(void* p, V v) {
  __builtin_memcpy(p, &v, sizeof v);
}

inline F64 abs(F64 x) { return from_bits(bits(x) & ~kSignBit64); }
inline F32 abs(F32 x) { return from_bits(bits(x) & ~kSignBit32); }
inline F64 with_sign(F64 magnitude, F64 sign) {
  return from_bits(bits(magnitude) | (bits(sign) & kSignBit64));
}
inline F32 with_sign(F32 magnitude, F32 sign) {
  return from_bits(bits(magnitude) | (bits(sign) & kSignBit32));
}

#if TRIBENCH_LANE_BYTES == 64

// The forms with an all-ones mask are the plain instructions; GCC 12 warns about its own headers
// in the plain forms.
inline F64 fma(F64 a, F64 b, F64 c) { return _mm512_fmadd_pd(a, b, c); }
inline F32 fma(F32 a, F32 b, F32 c) { return _mm512_fmadd_ps(a, b, c); }
inline F64 sqrt(F64 x) { return _mm512_maskz_sqrt_pd(0xff, x); }
inline F32 sqrt(F32 x) { return _mm512_maskz_sqrt_ps(0xffff, x); }
// The smaller (larger) of both; x where x is NaN.
inline F64 min(double bound, F64 x) { return _mm512_maskz_min_pd(0xff, splat(bound), x); }
inline F32 min(float bound, F32 x) { return _mm512_maskz_min_ps(0xffff, splat(bound), x); }
inline F64 max(double bound, F64 x) { return _mm512_maskz_max_pd(0xff, splat(bound), x); }
inline F32 max(float bound, F32 x) { return _mm512_maskz_max_ps(0xffff, splat(bound), x); }
// Whether a finite lane lies above; NaN and infinities do not count.
inline bool any_finite_above(F64 x, double bound) {
  return _mm512_mask_cmp_pd_mask(_mm512_cmp_pd_mask(x, splat(bound), _CMP_GT_OQ), x,
                                 splat(__builtin_inf()), _CMP_LT_OQ) != 0;
}
inline bool any_finite_above(F32 x, float bound) {
  return _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(x, splat(bound), _CMP_GT_OQ), x,
                                 splat(__builtin_inff()), _CMP_LT_OQ) != 0;
}
inline bool any_outside(F64 x, double low, double below) {  // of [low, below); true where NaN
  return (_mm512_cmp_pd_mask(x, splat(low), _CMP_NGE_UQ) |
          _mm512_cmp_pd_mask(x, splat(below), _CMP_NLT_UQ)) != 0;
}
inline bool any_outside(F32 x, float low, float below) {
  return (_mm512_cmp_ps_mask(x, splat(low), _CMP_NGE_UQ) |
          _mm512_cmp_ps_mask(x, splat(below), _CMP_NLT_UQ)) != 0;
}
inline F64 load_part(const double* p, std::size_t n) {
  return _mm512_maskz_loadu_pd(static_cast<__mmask8>((1U << n) - 1U), p);
}
inline F32 load_part(const float* p, std::size_t n) {
  return _mm512_maskz_loadu_ps(static_cast<__mmask16>((1U << n) - 1U), p);
}
inline void store_part(double* p, F64 v, std::size_t n) {
  _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1U << n) - 1U), v);
}
inline void store_part(float* p, F32 v, std::size_t n) {
  _mm512_mask_storeu_ps(p, static_cast<__mmask16>((1U << n) - 1U), v);
}

// a / b, correctly rounded, by multiplications: Markstein 1990 ("Computation of elementary
// functions on the IBM RISC System/6000"), theorems 1 and 2; Cornea, Harrison, Tang 2002,
// section 5. About twice as fast as Intel's divider, which works beside it. Needs exponents of a
// and b in the middle half of their range, so that nothing on the way over- or underflows, and a
// significand of b that is not all ones (there the reciprocal may be rounded the wrong way); else
// the divider does it.
template <typename V>
inline V quotient_from_reciprocal(V a, V b, V y) {  // y within an ulp of 1 / b
  const V one = V{} + 1;
  y = fma(fma(-b, y, one), y, y);  // the rounded reciprocal
  const V q = a * y;
  return fma(fma(-b, q, a), y, q);
}

inline F64 divide_by_multiplying(F64 a, F64 b) {
  constexpr std::uint64_t kShift = std::uint64_t{512} << 52;  // to the top bit of the exponent
  const auto usual = (__m512i)((bits(a) + kShift) & (bits(b) + kShift));
  const __mmask8 good =
      _mm512_mask_test_epi64_mask(_mm512_test_epi64_mask(usual, (__m512i)(I64{} + (1L << 62))),
                                  (__m512i)(bits(b) + 1), (__m512i)(I64{} + 0x000fffffffffffff));
  if (good != 0xff) [[unlikely]]
    return a / b;
  F64 y = _mm512_maskz_rcp14_pd(0xff, b);
  F64 e = fma(-b, y, splat(1.0));
  y = fma(fma(e, e, e), y, y);  // to 2^-42
  e = fma(-b, y, splat(1.0));
  return quotient_from_reciprocal(a, b, fma(e, y, y));
}

inline F32 divide_by_multiplying(F32 a, F32 b) {
  constexpr std::uint32_t kShift = 64U << 23;
  const auto usual = (__m512i)((bits(a) + kShift) & (bits(b) + kShift));
  const __mmask16 good =
      _mm512_mask_test_epi32_mask(_mm512_test_epi32_mask(usual, (__m512i)(I32{} + (1 << 30))),
                                  (__m512i)(bits(b) + 1), (__m512i)(I32{} + 0x007fffff));
  if (good != 0xffff) [[unlikely]]
    return a / b;
  F32 y = _mm512_maskz_rcp14_ps(0xffff, b);
  y = fma(fma(-b, y, splat(1.0F)), y, y);  // to an ulp
  return quotient_from_reciprocal(a, b, y);
}

#elif TRIBENCH_LANE_BYTES == 32

inline F64 fma(F64 a, F64 b, F64 c) { return _mm256_fmadd_pd(a, b, c); }
inline F32 fma(F32 a, F32 b, F32 c) { return _mm256_fmadd_ps(a, b, c); }
inline F64 sqrt(F64 x) { return _mm256_sqrt_pd(x); }
inline F32 sqrt(F32 x) { return _mm256_sqrt_ps(x); }
inline F64 min(double bound, F64 x) { return _mm256_min_pd(splat(bound), x); }
inline F32 min(float bound, F32 x) { return _mm256_min_ps(splat(bound), x); }
inline F64 max(double bound, F64 x) { return _mm256_max_pd(splat(bound), x); }
inline F32 max(float bound, F32 x) { return _mm256_max_ps(splat(bound), x); }
inline bool any_finite_above(F64 x, double bound) {
  return _mm256_movemask_pd(_mm256_and_pd(_mm256_cmp_pd(x, splat(bound), _CMP_GT_OQ),
                                          _mm256_cmp_pd(x, splat(__builtin_inf()), _CMP_LT_OQ))) !=
         0;
}
inline bool any_finite_above(F32 x, float bound) {
  return _mm256_movemask_ps(_mm256_and_ps(_mm256_cmp_ps(x, splat(bound), _CMP_GT_OQ),
                                          _mm256_cmp_ps(x, splat(__builtin_inff()), _CMP_LT_OQ))) !=
         0;
}
inline bool any_outside(F64 x, double low, double below) {
  return _mm256_movemask_pd(_mm256_or_pd(_mm256_cmp_pd(x, splat(low), _CMP_NGE_UQ),
                                         _mm256_cmp_pd(x, splat(below), _CMP_NLT_UQ))) != 0;
}
inline bool any_outside(F32 x, float low, float below) {
  return _mm256_movemask_ps(_mm256_or_ps(_mm256_cmp_ps(x, splat(low), _CMP_NGE_UQ),
                                         _mm256_cmp_ps(x, splat(below), _CMP_NLT_UQ))) != 0;
}
inline __m256i part_mask64(std::size_t n) {
  const I64 lane = {0, 1, 2, 3};
  return (__m256i)(lane < static_cast<std::int64_t>(n));
}
inline __m256i part_mask32(std::size_t n) {
  const I32 lane = {0, 1, 2, 3, 4, 5, 6, 7};
  return (__m256i)(lane < static_cast<std::int32_t>(n));
}
inline F64 load_part(const double* p, std::size_t n) {
  return _mm256_maskload_pd(p, part_mask64(n));
}
inline F32 load_part(const float* p, std::size_t n) {
  return _mm256_maskload_ps(p, part_mask32(n));
}
inline void store_part(double* p, F64 v, std::size_t n) {
  _mm256_maskstore_pd(p, part_mask64(n), v);
}
inline void store_part(float* p, F32 v, std::size_t n) {
  _mm256_maskstore_ps(p, part_mask32(n), v);
}

#else

// Without the instruction the C library fuses: correct everywhere, slow where it must emulate.
inline F64 fma(F64 a, F64 b, F64 c) {
  F64 r{};
  for (int i = 0; i < 2; ++i) r[i] = __builtin_fma(a[i], b[i], c[i]);
  return r;
}
inline F32 fma(F32 a, F32 b, F32 c) {
  F32 r{};
  for (int i = 0; i < 4; ++i) r[i] = __builtin_fmaf(a[i], b[i], c[i]);
  return r;
}
inline F64 sqrt(F64 x) {
  F64 r{};
  for (int i = 0; i < 2; ++i) r[i] = __builtin_sqrt(x[i]);
  return r;
}
inline F32 sqrt(F32 x) {
  F32 r{};
  for (int i = 0; i < 4; ++i) r[i] = __builtin_sqrtf(x[i]);
  return r;
}
inline F64 min(double bound, F64 x) { return x > bound ? splat(bound) : x; }
inline F32 min(float bound, F32 x) { return x > bound ? splat(bound) : x; }
inline F64 max(double bound, F64 x) { return x < bound ? splat(bound) : x; }
inline F32 max(float bound, F32 x) { return x < bound ? splat(bound) : x; }
inline bool any(I64 mask) { return (mask[0] | mask[1]) != 0; }
inline bool any(I32 mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
inline bool any_finite_above(F64 x, double bound) {
  return any((I64)((x > bound) & (x < __builtin_inf())));
}
inline bool any_finite_above(F32 x, float bound) {
  return any((I32)((x > bound) & (x < __builtin_inff())));
}
inline bool any_outside(F64 x, double low, double below) {
  return any((I64) ~((x >= low) & (x < below)));
}
inline bool any_outside(F32 x, float low, float below) {
  return any((I32) ~((x >= low) & (x < below)));
}
template <typename T>
inline Vector<T> load_part(const T* p, std::size_t n) {
  Vector<T> v{};
  for (std::size_t i = 0; i < n; ++i) v[i] = p[i];
  return v;
}
template <typename V, typename T>
inline void store_part(T* p, V v, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) p[i] = v[i];
}

#endif

#if TRIBENCH_LANE_BYTES != 64
inline F64 divide_by_multiplying(F64 a, F64 b) { return a / b; }
inline F32 divide_by_multiplying(F32 a, F32 b) { return a / b; }
#endif

}  // namespace
}  // namespace tribench
