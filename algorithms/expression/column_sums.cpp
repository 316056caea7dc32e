// SPDX-License-Identifier: MIT
//
// Sums and products of columns (column_kernels.hpp).
#include <algorithm>
#include <cstring>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench::columns {
namespace {

// A row of lanes, and sums of it: eight numbers, added to one another in one fixed order at the
// end. How many of them an instruction takes changes no bit. Where it is fewer than eight, the row
// stands as halves: GCC 12 keeps a vector that no register holds in memory, at a fifth of the
// speed.
constexpr std::size_t kLanes = 8;
using FourLanes = double __attribute__((vector_size(kLanes / 2 * sizeof(double))));
using EightLanes = double __attribute__((vector_size(kLanes * sizeof(double))));

#define TRIBENCH_INLINE __attribute__((always_inline)) inline

struct Halves {
  FourLanes low;
  FourLanes high;

  TRIBENCH_INLINE void load(const double* a) {
    std::memcpy(&low, a, sizeof low);
    std::memcpy(&high, a + kLanes / 2, sizeof high);
  }
  TRIBENCH_INLINE void store(double* a) const {
    std::memcpy(a, &low, sizeof low);
    std::memcpy(a + kLanes / 2, &high, sizeof high);
  }
  TRIBENCH_INLINE void add(const Halves& x) {
    low += x.low;
    high += x.high;
  }
  TRIBENCH_INLINE void add_product(const Halves& x, const Halves& y) {
    low += x.low * y.low;
    high += x.high * y.high;
  }
  TRIBENCH_INLINE void add_product(const Halves& x, double factor) {
    low += x.low * factor;
    high += x.high * factor;
  }
  TRIBENCH_INLINE double sum() const {
    const FourLanes both = low + high;
    return (both[0] + both[2]) + (both[1] + both[3]);
  }
};

struct Whole {
  EightLanes all;

  TRIBENCH_INLINE void load(const double* a) { std::memcpy(&all, a, sizeof all); }
  TRIBENCH_INLINE void store(double* a) const { std::memcpy(a, &all, sizeof all); }
  TRIBENCH_INLINE void add(const Whole& x) { all += x.all; }
  TRIBENCH_INLINE void add_product(const Whole& x, const Whole& y) { all += x.all * y.all; }
  TRIBENCH_INLINE void add_product(const Whole& x, double factor) { all += x.all * factor; }
  TRIBENCH_INLINE double sum() const {
    return ((all[0] + all[4]) + (all[2] + all[6])) + ((all[1] + all[5]) + (all[3] + all[7]));
  }
};

template <typename Lanes>
TRIBENCH_INLINE double sum_of(const double* a, std::size_t n) {
  Lanes total = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes x;
    x.load(a + i);
    total.add(x);
  }
  double rest = 0;
  for (; i < n; ++i) rest += a[i];
  return total.sum() + rest;
}

// Four chains of additions at once: one would wait for itself.
template <typename Lanes>
TRIBENCH_INLINE double dot_of(const double* a, const double* b, std::size_t n) {
  constexpr std::size_t kChains = 4;
  Lanes total[kChains] = {};
  std::size_t i = 0;
  for (; i + kChains * kLanes <= n; i += kChains * kLanes) {
    for (std::size_t k = 0; k < kChains; ++k) {
      Lanes x;
      Lanes y;
      x.load(a + i + k * kLanes);
      y.load(b + i + k * kLanes);
      total[k].add_product(x, y);
    }
  }
  for (std::size_t k = 0; i + kLanes <= n; i += kLanes, ++k) {
    Lanes x;
    Lanes y;
    x.load(a + i);
    y.load(b + i);
    total[k].add_product(x, y);
  }
  double rest = 0;
  for (; i < n; ++i) rest += a[i] * b[i];
  total[0].add(total[1]);
  total[2].add(total[3]);
  total[0].add(total[2]);
  return total[0].sum() + rest;
}

template <typename Lanes>
TRIBENCH_INLINE void dot4_of(const double* a, const double* const b[4], std::size_t n,
                             double sums[4]) {
  Lanes total0 = {};
  Lanes total1 = {};
  Lanes total2 = {};
  Lanes total3 = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes x;
    Lanes y;
    x.load(a + i);
    y.load(b[0] + i);
    total0.add_product(x, y);
    y.load(b[1] + i);
    total1.add_product(x, y);
    y.load(b[2] + i);
    total2.add_product(x, y);
    y.load(b[3] + i);
    total3.add_product(x, y);
  }
  double rest[4] = {};
  for (; i < n; ++i) {
    for (int j = 0; j < 4; ++j) rest[j] += a[i] * b[j][i];
  }
  sums[0] = total0.sum() + rest[0];
  sums[1] = total1.sum() + rest[1];
  sums[2] = total2.sum() + rest[2];
  sums[3] = total3.sum() + rest[3];
}

// Of every row of lanes the Part that begins at `first`. Written out: GCC 12 keeps arrays of sums
// in memory, at a third of the speed.
template <typename Part>
TRIBENCH_INLINE void add_parts(const double* const a[2], const double* const b[4], std::size_t n,
                               std::size_t first, Part sums[8]) {
  Part s00 = {}, s01 = {}, s02 = {}, s03 = {};
  Part s10 = {}, s11 = {}, s12 = {}, s13 = {};
  for (std::size_t i = first; i - first + kLanes <= n; i += kLanes) {
    Part upper;
    Part lower;
    Part y;
    std::memcpy(&upper, a[0] + i, sizeof upper);
    std::memcpy(&lower, a[1] + i, sizeof lower);
    std::memcpy(&y, b[0] + i, sizeof y);
    s00 += upper * y;
    s10 += lower * y;
    std::memcpy(&y, b[1] + i, sizeof y);
    s01 += upper * y;
    s11 += lower * y;
    std::memcpy(&y, b[2] + i, sizeof y);
    s02 += upper * y;
    s12 += lower * y;
    std::memcpy(&y, b[3] + i, sizeof y);
    s03 += upper * y;
    s13 += lower * y;
  }
  sums[0] = s00, sums[1] = s01, sums[2] = s02, sums[3] = s03;
  sums[4] = s10, sums[5] = s11, sums[6] = s12, sums[7] = s13;
}

TRIBENCH_INLINE void add_rows(const double* const a[2], const double* const b[4], std::size_t n,
                              Whole sums[8]) {
  EightLanes all[8];
  add_parts(a, b, n, 0, all);
  for (std::size_t k = 0; k < 8; ++k) sums[k] = {all[k]};
}
// Sixteen halves would not stay in sixteen registers: one half after the other.
TRIBENCH_INLINE void add_rows(const double* const a[2], const double* const b[4], std::size_t n,
                              Halves sums[8]) {
  FourLanes low[8];
  FourLanes high[8];
  add_parts(a, b, n, 0, low);
  add_parts(a, b, n, kLanes / 2, high);
  for (std::size_t k = 0; k < 8; ++k) sums[k] = {low[k], high[k]};
}

// sums[4 i + j] = sum_r a[i][r] b[j][r]: the sums of dot4, six readings for eight products.
template <typename Lanes>
TRIBENCH_INLINE void dot2by4_of(const double* const a[2], const double* const b[4], std::size_t n,
                                double sums[8]) {
  Lanes rows[8];
  add_rows(a, b, n, rows);
  for (std::size_t k = 0; k < 8; ++k) {
    double rest = 0;
    for (std::size_t i = n - n % kLanes; i < n; ++i) rest += a[k / 4][i] * b[k % 4][i];
    sums[k] = rows[k].sum() + rest;
  }
}

// Whole rows of lanes where the processor takes eight numbers at once.
bool takes_whole_rows() {
  static const bool takes = TRIBENCH_HAS_AVX512 && vector_level() == VectorLevel::avx512;
  return takes;
}

TRIBENCH_AVX512 double whole_sum(const double* a, std::size_t n) { return sum_of<Whole>(a, n); }
TRIBENCH_EACH_LEVEL double half_sum(const double* a, std::size_t n) { return sum_of<Halves>(a, n); }

TRIBENCH_AVX512 double whole_dot(const double* a, const double* b, std::size_t n) {
  return dot_of<Whole>(a, b, n);
}
TRIBENCH_EACH_LEVEL double half_dot(const double* a, const double* b, std::size_t n) {
  return dot_of<Halves>(a, b, n);
}

TRIBENCH_AVX512 void whole_dot4(const double* a, const double* const b[4], std::size_t n,
                                double sums[4]) {
  dot4_of<Whole>(a, b, n, sums);
}
TRIBENCH_EACH_LEVEL void half_dot4(const double* a, const double* const b[4], std::size_t n,
                                   double sums[4]) {
  dot4_of<Halves>(a, b, n, sums);
}

TRIBENCH_AVX512 void whole_dot2by4(const double* const a[2], const double* const b[4],
                                   std::size_t n, double sums[8]) {
  dot2by4_of<Whole>(a, b, n, sums);
}
TRIBENCH_EACH_LEVEL void half_dot2by4(const double* const a[2], const double* const b[4],
                                      std::size_t n, double sums[8]) {
  dot2by4_of<Halves>(a, b, n, sums);
}

// sums[4 i + j] = sum_r a[i][r] b[j][r], the same sums: eight readings for sixteen products, which
// stay in the 32 registers of such processors. Written out as add_parts is.
TRIBENCH_AVX512 void whole_dot4by4(const double* const a[4], const double* const b[4],
                                   std::size_t n, double sums[16]) {
  EightLanes s00 = {}, s01 = {}, s02 = {}, s03 = {};
  EightLanes s10 = {}, s11 = {}, s12 = {}, s13 = {};
  EightLanes s20 = {}, s21 = {}, s22 = {}, s23 = {};
  EightLanes s30 = {}, s31 = {}, s32 = {}, s33 = {};
  for (std::size_t i = 0; i + kLanes <= n; i += kLanes) {
    EightLanes x0, x1, x2, x3, y;
    std::memcpy(&x0, a[0] + i, sizeof x0);
    std::memcpy(&x1, a[1] + i, sizeof x1);
    std::memcpy(&x2, a[2] + i, sizeof x2);
    std::memcpy(&x3, a[3] + i, sizeof x3);
    std::memcpy(&y, b[0] + i, sizeof y);
    s00 += x0 * y, s10 += x1 * y, s20 += x2 * y, s30 += x3 * y;
    std::memcpy(&y, b[1] + i, sizeof y);
    s01 += x0 * y, s11 += x1 * y, s21 += x2 * y, s31 += x3 * y;
    std::memcpy(&y, b[2] + i, sizeof y);
    s02 += x0 * y, s12 += x1 * y, s22 += x2 * y, s32 += x3 * y;
    std::memcpy(&y, b[3] + i, sizeof y);
    s03 += x0 * y, s13 += x1 * y, s23 += x2 * y, s33 += x3 * y;
  }
  const EightLanes all[16] = {s00, s01, s02, s03, s10, s11, s12, s13,
                              s20, s21, s22, s23, s30, s31, s32, s33};
  for (std::size_t k = 0; k < 16; ++k) {
    double rest = 0;
    for (std::size_t i = n - n % kLanes; i < n; ++i) rest += a[k / 4][i] * b[k % 4][i];
    sums[k] = Whole{all[k]}.sum() + rest;
  }
}

struct Columns {
  const double* const* all;
  std::size_t count;
};

// So many columns of `left`, two or four, by four of `right`, from i and j on; where they end, the
// last one stands for those that are not there.
void add_products(const Columns& left, std::size_t i, std::size_t taken, const Columns& right,
                  std::size_t j, std::size_t row, std::size_t rows, double* products) {
  const double* some[4];
  const double* four[4];
  for (std::size_t k = 0; k < taken; ++k) some[k] = left.all[std::min(i + k, left.count - 1)] + row;
  for (std::size_t k = 0; k < 4; ++k) four[k] = right.all[std::min(j + k, right.count - 1)] + row;
  double sums[16];
  if (taken == 4) {
    whole_dot4by4(some, four, rows, sums);
  } else {
    (takes_whole_rows() ? whole_dot2by4 : half_dot2by4)(some, four, rows, sums);
  }
  for (std::size_t k = 0; k < taken && i + k < left.count; ++k) {
    for (std::size_t l = 0; l < 4 && j + l < right.count; ++l) {
      products[(i + k) * right.count + j + l] += sums[4 * k + l];
    }
  }
}

// Rows in tiles, so that all columns of a tile stay in cache. Of a triangle what lies right of the
// diagonal, and some of the rest.
void add_tiles(const Columns& left, const Columns& right, std::size_t n, bool triangle,
               double* products) {
  constexpr std::size_t kTile = 512;
  for (std::size_t k = 0; k < left.count * right.count; ++k) products[k] = 0;
  for (std::size_t row = 0; row < n; row += kTile) {
    const std::size_t rows = std::min(kTile, n - row);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < left.count; i += taken) {
      taken = takes_whole_rows() && left.count - i > 2 ? 4 : 2;
      for (std::size_t j = triangle ? i : 0; j < right.count; j += 4) {
        add_products(left, i, taken, right, j, row, rows, products);
      }
    }
  }
}

}  // namespace

double sum(const double* a, std::size_t n) {
  return takes_whole_rows() ? whole_sum(a, n) : half_sum(a, n);
}

double dot(const double* a, const double* b, std::size_t n) {
  return takes_whole_rows() ? whole_dot(a, b, n) : half_dot(a, b, n);
}

void dot4(const double* a, const double* const b[4], std::size_t n, double sums[4]) {
  (takes_whole_rows() ? whole_dot4 : half_dot4)(a, b, n, sums);
}

void gram(const double* const* columns, std::size_t count, std::size_t n, double* products) {
  add_tiles({columns, count}, {columns, count}, n, true, products);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) products[i * count + j] = products[j * count + i];
  }
}

void cross_products(const double* const* left, std::size_t left_count, const double* const* right,
                    std::size_t right_count, std::size_t n, double* products) {
  add_tiles({left, left_count}, {right, right_count}, n, false, products);
}

namespace {

// A tile of 16 rows and 4 columns stays in registers while `inner` runs: sums of their own, since
// the compiler keeps an array of them in memory.
constexpr std::size_t kTileRows = 2 * kLanes;

template <typename Lanes>
TRIBENCH_INLINE void add_tile_of_4(const double* a, const double* b, std::size_t rows,
                                   std::size_t inner, double* out) {
  Lanes s00, s01, s10, s11, s20, s21, s30, s31;
  s00.load(out), s01.load(out + kLanes);
  s10.load(out + rows), s11.load(out + rows + kLanes);
  s20.load(out + 2 * rows), s21.load(out + 2 * rows + kLanes);
  s30.load(out + 3 * rows), s31.load(out + 3 * rows + kLanes);
  for (std::size_t k = 0; k < inner; ++k, a += rows) {
    Lanes upper;
    Lanes lower;
    upper.load(a);
    lower.load(a + kLanes);
    s00.add_product(upper, b[k]);
    s01.add_product(lower, b[k]);
    s10.add_product(upper, b[inner + k]);
    s11.add_product(lower, b[inner + k]);
    s20.add_product(upper, b[2 * inner + k]);
    s21.add_product(lower, b[2 * inner + k]);
    s30.add_product(upper, b[3 * inner + k]);
    s31.add_product(lower, b[3 * inner + k]);
  }
  s00.store(out), s01.store(out + kLanes);
  s10.store(out + rows), s11.store(out + rows + kLanes);
  s20.store(out + 2 * rows), s21.store(out + 2 * rows + kLanes);
  s30.store(out + 3 * rows), s31.store(out + 3 * rows + kLanes);
}

template <typename Lanes>
TRIBENCH_INLINE void add_tile_of_1(const double* a, const double* b, std::size_t rows,
                                   std::size_t inner, double* out) {
  Lanes upper;
  Lanes lower;
  upper.load(out);
  lower.load(out + kLanes);
  for (std::size_t k = 0; k < inner; ++k, a += rows) {
    Lanes x;
    x.load(a);
    upper.add_product(x, b[k]);
    x.load(a + kLanes);
    lower.add_product(x, b[k]);
  }
  upper.store(out);
  lower.store(out + kLanes);
}

template <typename Lanes>
TRIBENCH_INLINE void add_product_of(const double* a, const double* b, std::size_t rows,
                                    std::size_t inner, std::size_t count, double* out) {
  const std::size_t whole = rows - rows % kTileRows;
  for (std::size_t i = 0; i < whole; i += kTileRows) {
    std::size_t j = 0;
    for (; j + 4 <= count; j += 4) {
      add_tile_of_4<Lanes>(a + i, b + j * inner, rows, inner, out + j * rows + i);
    }
    for (; j < count; ++j) {
      add_tile_of_1<Lanes>(a + i, b + j * inner, rows, inner, out + j * rows + i);
    }
  }
  for (std::size_t j = 0; whole < rows && j < count; ++j) {
    for (std::size_t k = 0; k < inner; ++k) {
      const double factor = b[j * inner + k];
      for (std::size_t i = whole; i < rows; ++i) out[j * rows + i] += a[k * rows + i] * factor;
    }
  }
}

TRIBENCH_AVX512 void whole_add_product(const double* a, const double* b, std::size_t rows,
                                       std::size_t inner, std::size_t count, double* out) {
  add_product_of<Whole>(a, b, rows, inner, count, out);
}
TRIBENCH_EACH_LEVEL void half_add_product(const double* a, const double* b, std::size_t rows,
                                          std::size_t inner, std::size_t count, double* out) {
  add_product_of<Halves>(a, b, rows, inner, count, out);
}

}  // namespace

void add_product(const double* a, const double* b, std::size_t rows, std::size_t inner,
                 std::size_t count, double* out) {
  (takes_whole_rows() ? whole_add_product : half_add_product)(a, b, rows, inner, count, out);
}

}  // namespace tribench::columns
