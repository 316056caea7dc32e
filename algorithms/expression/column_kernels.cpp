// SPDX-License-Identifier: MIT
#include "algorithms/expression/column_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/expression/vector/kernels.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench::columns {
namespace {

constexpr std::size_t kLanes = 8;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

// The lanes in one fixed order, then what did not fill a row of lanes.
#define TRIBENCH_SUM_LANES(v) \
  ((((v)[0] + (v)[4]) + ((v)[2] + (v)[6])) + (((v)[1] + (v)[5]) + ((v)[3] + (v)[7])))

// The evaluator's own kernels, so that values and derivatives meet bit for bit.
const KernelTable<double>& kernels() {
  static const KernelTable<double>& table = kernel_table<double>(vector_level());
  return table;
}

void apply(Op function, const double* a, double* out, std::size_t n) {
  kernels().function[static_cast<int>(function) - static_cast<int>(Op::neg)](out, a, nullptr,
                                                                             nullptr, n);
}

void combine(Op operation, OperandForm form, const double* a, const double* b, double* out,
             std::size_t n) {
  kernels().binary[static_cast<int>(operation) - static_cast<int>(Op::add)][form](out, a, b,
                                                                                  nullptr, n);
}

}  // namespace

void add(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::add, kFormVV, a, b, out, n);
}
void add(const double* a, double b, double* out, std::size_t n) {
  combine(Op::add, kFormVS, a, &b, out, n);
}
void sub(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::sub, kFormVV, a, b, out, n);
}
void sub(double a, const double* b, double* out, std::size_t n) {
  combine(Op::sub, kFormSV, &a, b, out, n);
}
void mul(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::mul, kFormVV, a, b, out, n);
}
void mul(const double* a, double b, double* out, std::size_t n) {
  combine(Op::mul, kFormVS, a, &b, out, n);
}
void div(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::div, kFormVV, a, b, out, n);
}
void div(double a, const double* b, double* out, std::size_t n) {
  combine(Op::div, kFormSV, &a, b, out, n);
}
void div(const double* a, double b, double* out, std::size_t n) {
  combine(Op::div, kFormVS, a, &b, out, n);
}

void sqrt(const double* a, double* out, std::size_t n) { apply(Op::sqrt, a, out, n); }
void abs(const double* a, double* out, std::size_t n) { apply(Op::abs, a, out, n); }
void sgn(const double* a, double* out, std::size_t n) { apply(Op::sgn, a, out, n); }

void integer_power(const double* a, int exponent, double* out, std::size_t n) {
  if (exponent == 2) return combine(Op::mul, kFormVV, a, a, out, n);
  const double size = exponent;
  kernels().integer_power(out, a, &size, nullptr, n);
}

TRIBENCH_EACH_LEVEL void one_minus_square(const double* a, double* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = 1 - a[i] * a[i];
}

void exp(const double* a, double* out, std::size_t n) { apply(Op::exp, a, out, n); }
void log(const double* a, double* out, std::size_t n) { apply(Op::log, a, out, n); }
void sin(const double* a, double* out, std::size_t n) { apply(Op::sin, a, out, n); }
void cos(const double* a, double* out, std::size_t n) { apply(Op::cos, a, out, n); }
void tanh(const double* a, double* out, std::size_t n) { apply(Op::tanh, a, out, n); }
void pow(const double* a, const double* b, double* out, std::size_t n) {
  kernels().power[kFormVV](out, a, b, nullptr, n);
}

TRIBENCH_EACH_LEVEL void add_combination(const double* const* columns, const double* coefficients,
                                         std::size_t count, double* out, std::size_t n) {
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {
    const double* a = columns[j];
    const double* b = columns[j + 1];
    const double* c = columns[j + 2];
    const double* d = columns[j + 3];
    const double ca = coefficients[j];
    const double cb = coefficients[j + 1];
    const double cc = coefficients[j + 2];
    const double cd = coefficients[j + 3];
    for (std::size_t i = 0; i < n; ++i) {
      out[i] += (ca * a[i] + cb * b[i]) + (cc * c[i] + cd * d[i]);
    }
  }
  for (; j < count; ++j) {
    const double* a = columns[j];
    const double ca = coefficients[j];
    for (std::size_t i = 0; i < n; ++i) out[i] += ca * a[i];
  }
}

void combine(const double* const* columns, const double* coefficients, std::size_t count,
             double* out, std::size_t n) {
  std::fill(out, out + n, 0.0);
  add_combination(columns, coefficients, count, out, n);
}

TRIBENCH_EACH_LEVEL double sum(const double* a, std::size_t n) {
  Lanes total = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes x;
    std::memcpy(&x, a + i, sizeof x);
    total += x;
  }
  double rest = 0;
  for (; i < n; ++i) rest += a[i];
  return TRIBENCH_SUM_LANES(total) + rest;
}

// Four chains of additions at once: one would wait for itself.
TRIBENCH_EACH_LEVEL double dot(const double* a, const double* b, std::size_t n) {
  constexpr std::size_t kChains = 4;
  Lanes total[kChains] = {};
  std::size_t i = 0;
  for (; i + kChains * kLanes <= n; i += kChains * kLanes) {
    for (std::size_t k = 0; k < kChains; ++k) {
      Lanes x;
      Lanes y;
      std::memcpy(&x, a + i + k * kLanes, sizeof x);
      std::memcpy(&y, b + i + k * kLanes, sizeof y);
      total[k] += x * y;
    }
  }
  for (std::size_t k = 0; i + kLanes <= n; i += kLanes, ++k) {
    Lanes x;
    Lanes y;
    std::memcpy(&x, a + i, sizeof x);
    std::memcpy(&y, b + i, sizeof y);
    total[k] += x * y;
  }
  double rest = 0;
  for (; i < n; ++i) rest += a[i] * b[i];
  const Lanes all = (total[0] + total[1]) + (total[2] + total[3]);
  return TRIBENCH_SUM_LANES(all) + rest;
}

TRIBENCH_EACH_LEVEL void dot4(const double* a, const double* const b[4], std::size_t n,
                              double sums[4]) {
  Lanes total0 = {};
  Lanes total1 = {};
  Lanes total2 = {};
  Lanes total3 = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes x;
    Lanes y;
    std::memcpy(&x, a + i, sizeof x);
    std::memcpy(&y, b[0] + i, sizeof y);
    total0 += x * y;
    std::memcpy(&y, b[1] + i, sizeof y);
    total1 += x * y;
    std::memcpy(&y, b[2] + i, sizeof y);
    total2 += x * y;
    std::memcpy(&y, b[3] + i, sizeof y);
    total3 += x * y;
  }
  double rest[4] = {};
  for (; i < n; ++i) {
    for (int j = 0; j < 4; ++j) rest[j] += a[i] * b[j][i];
  }
  sums[0] = TRIBENCH_SUM_LANES(total0) + rest[0];
  sums[1] = TRIBENCH_SUM_LANES(total1) + rest[1];
  sums[2] = TRIBENCH_SUM_LANES(total2) + rest[2];
  sums[3] = TRIBENCH_SUM_LANES(total3) + rest[3];
}

namespace {

// sums[4 i + j] = sum_r a[i][r] b[j][r]: the sums of dot4, six readings for eight products. Written
// out: GCC 12 keeps arrays of sums in memory, at a third of the speed.
TRIBENCH_EACH_LEVEL void dot2by4(const double* const a[2], const double* const b[4], std::size_t n,
                                 double sums[8]) {
  Lanes s00 = {}, s01 = {}, s02 = {}, s03 = {};
  Lanes s10 = {}, s11 = {}, s12 = {}, s13 = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes upper;
    Lanes lower;
    Lanes y;
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
  double rest[8] = {};
  for (; i < n; ++i) {
    for (int k = 0; k < 8; ++k) rest[k] += a[k / 4][i] * b[k % 4][i];
  }
  sums[0] = TRIBENCH_SUM_LANES(s00) + rest[0];
  sums[1] = TRIBENCH_SUM_LANES(s01) + rest[1];
  sums[2] = TRIBENCH_SUM_LANES(s02) + rest[2];
  sums[3] = TRIBENCH_SUM_LANES(s03) + rest[3];
  sums[4] = TRIBENCH_SUM_LANES(s10) + rest[4];
  sums[5] = TRIBENCH_SUM_LANES(s11) + rest[5];
  sums[6] = TRIBENCH_SUM_LANES(s12) + rest[6];
  sums[7] = TRIBENCH_SUM_LANES(s13) + rest[7];
}

struct Columns {
  const double* const* all;
  std::size_t count;
};

// Two columns of `left` by four of `right`, from i and j on; where they end, the last one stands
// for those that are not there.
void add_products(const Columns& left, std::size_t i, const Columns& right, std::size_t j,
                  std::size_t row, std::size_t rows, double* products) {
  const double* two[2];
  const double* four[4];
  for (std::size_t k = 0; k < 2; ++k) two[k] = left.all[std::min(i + k, left.count - 1)] + row;
  for (std::size_t k = 0; k < 4; ++k) four[k] = right.all[std::min(j + k, right.count - 1)] + row;
  double sums[8];
  dot2by4(two, four, rows, sums);
  for (std::size_t k = 0; k < 2 && i + k < left.count; ++k) {
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
    for (std::size_t i = 0; i < left.count; i += 2) {
      for (std::size_t j = triangle ? i : 0; j < right.count; j += 4) {
        add_products(left, i, right, j, row, rows, products);
      }
    }
  }
}

}  // namespace

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
// At any address. (An alignment that only an alias of the vector carries gets lost under clang.)
struct __attribute__((packed, may_alias)) FreeLanes {
  Lanes lanes;
};

__attribute__((always_inline)) inline void add_tile_of_4(const double* a, const double* b,
                                                         std::size_t rows, std::size_t inner,
                                                         double* out) {
  const auto at = [&](std::size_t j, std::size_t half) {
    return reinterpret_cast<FreeLanes*>(out + j * rows + half * kLanes);
  };
  Lanes s00 = at(0, 0)->lanes, s01 = at(0, 1)->lanes, s10 = at(1, 0)->lanes, s11 = at(1, 1)->lanes;
  Lanes s20 = at(2, 0)->lanes, s21 = at(2, 1)->lanes, s30 = at(3, 0)->lanes, s31 = at(3, 1)->lanes;
  for (std::size_t k = 0; k < inner; ++k, a += rows) {
    const Lanes upper = reinterpret_cast<const FreeLanes*>(a)->lanes;
    const Lanes lower = reinterpret_cast<const FreeLanes*>(a + kLanes)->lanes;
    s00 += upper * b[k];
    s01 += lower * b[k];
    s10 += upper * b[inner + k];
    s11 += lower * b[inner + k];
    s20 += upper * b[2 * inner + k];
    s21 += lower * b[2 * inner + k];
    s30 += upper * b[3 * inner + k];
    s31 += lower * b[3 * inner + k];
  }
  at(0, 0)->lanes = s00, at(0, 1)->lanes = s01, at(1, 0)->lanes = s10, at(1, 1)->lanes = s11;
  at(2, 0)->lanes = s20, at(2, 1)->lanes = s21, at(3, 0)->lanes = s30, at(3, 1)->lanes = s31;
}

__attribute__((always_inline)) inline void add_tile_of_1(const double* a, const double* b,
                                                         std::size_t rows, std::size_t inner,
                                                         double* out) {
  auto* at = reinterpret_cast<FreeLanes*>(out);
  Lanes upper = at[0].lanes, lower = at[1].lanes;
  for (std::size_t k = 0; k < inner; ++k, a += rows) {
    upper += reinterpret_cast<const FreeLanes*>(a)->lanes * b[k];
    lower += reinterpret_cast<const FreeLanes*>(a + kLanes)->lanes * b[k];
  }
  at[0].lanes = upper, at[1].lanes = lower;
}

}  // namespace

TRIBENCH_EACH_LEVEL
void add_product(const double* a, const double* b, std::size_t rows, std::size_t inner,
                 std::size_t count, double* out) {
  const std::size_t whole = rows - rows % kTileRows;
  for (std::size_t i = 0; i < whole; i += kTileRows) {
    std::size_t j = 0;
    for (; j + 4 <= count; j += 4) {
      add_tile_of_4(a + i, b + j * inner, rows, inner, out + j * rows + i);
    }
    for (; j < count; ++j) add_tile_of_1(a + i, b + j * inner, rows, inner, out + j * rows + i);
  }
  for (std::size_t j = 0; whole < rows && j < count; ++j) {
    for (std::size_t k = 0; k < inner; ++k) {
      const double factor = b[j * inner + k];
      for (std::size_t i = whole; i < rows; ++i) out[j * rows + i] += a[k * rows + i] * factor;
    }
  }
}

}  // namespace tribench::columns
