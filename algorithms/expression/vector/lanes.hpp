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
  using I = I64;
  using U = U64;
};
template <>
struct Lanes<float> {
  using V = F32;
  using I = I32;
  using U = U32;
};
template <typename T>
using Vector = typename Lanes<T>::V;
template <typename T>
constexpr std::size_t kWidth = kLaneBytes / sizeof(T);

// x - 0 keeps the sign of zero, unlike x + 0.
inline F64 splat(double x) { return x - F64{}; }
inline F32 splat(float x) { return x - F32{}; }

inline I64 bits(F64 x) { return reinterpret_cast<I64&>(x); }
inline I32 bits(F32 x) { return reinterpret_cast<I32&>(x); }
inline F64 from_bits(I64 x) { return reinterpret_cast<F64&>(x); }
inline F32 from_bits(I32 x) { return reinterpret_cast<F32&>(x); }

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

inline F64 sign_bits(F64 x) { return from_bits(bits(x) & INT64_MIN); }
inline F32 sign_bits(F32 x) { return from_bits(bits(x) & INT32_MIN); }
inline F64 abs(F64 x) { return from_bits(bits(x) & INT64_MAX); }
inline F32 abs(F32 x) { return from_bits(bits(x) & INT32_MAX); }
inline F64 with_sign(F64 magnitude, F64 sign) {
  return from_bits(bits(magnitude) | (bits(sign) & INT64_MIN));
}
inline F32 with_sign(F32 magnitude, F32 sign) {
  return from_bits(bits(magnitude) | (bits(sign) & INT32_MIN));
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
inline bool any(I64 mask) { return _mm512_movepi64_mask((__m512i)mask) != 0; }
inline bool any(I32 mask) { return _mm512_movepi32_mask((__m512i)mask) != 0; }
inline bool any_above(F64 x, double bound) {  // true where NaN
  return _mm512_cmp_pd_mask(x, splat(bound), _CMP_NLE_UQ) != 0;
}
inline bool any_above(F32 x, float bound) {
  return _mm512_cmp_ps_mask(x, splat(bound), _CMP_NLE_UQ) != 0;
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

#elif TRIBENCH_LANE_BYTES == 32

inline F64 fma(F64 a, F64 b, F64 c) { return _mm256_fmadd_pd(a, b, c); }
inline F32 fma(F32 a, F32 b, F32 c) { return _mm256_fmadd_ps(a, b, c); }
inline F64 sqrt(F64 x) { return _mm256_sqrt_pd(x); }
inline F32 sqrt(F32 x) { return _mm256_sqrt_ps(x); }
inline F64 min(double bound, F64 x) { return _mm256_min_pd(splat(bound), x); }
inline F32 min(float bound, F32 x) { return _mm256_min_ps(splat(bound), x); }
inline F64 max(double bound, F64 x) { return _mm256_max_pd(splat(bound), x); }
inline F32 max(float bound, F32 x) { return _mm256_max_ps(splat(bound), x); }
inline bool any(I64 mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
inline bool any(I32 mask) { return _mm256_movemask_ps((__m256)mask) != 0; }
inline bool any_above(F64 x, double bound) {
  return _mm256_movemask_pd(_mm256_cmp_pd(x, splat(bound), _CMP_NLE_UQ)) != 0;
}
inline bool any_above(F32 x, float bound) {
  return _mm256_movemask_ps(_mm256_cmp_ps(x, splat(bound), _CMP_NLE_UQ)) != 0;
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
inline bool any_above(F64 x, double bound) { return any((I64) ~(x <= bound)); }
inline bool any_above(F32 x, float bound) { return any((I32) ~(x <= bound)); }
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

}  // namespace
}  // namespace tribench
