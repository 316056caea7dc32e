// SPDX-License-Identifier: MIT
#include "algorithms/inference/column_products.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "algorithms/expression/vector/each_level.hpp"

namespace tribench::loop {
namespace {

using Eigen::Index;

constexpr Index kPartialSums = 8;  // of a pair of columns, side by side
constexpr Index kRowsAtOnce = 1024;
constexpr Index kLeft = 4;  // columns of a tile: its sums stay in registers
constexpr Index kRight = 2;
using Sums = double __attribute__((vector_size(kPartialSums * sizeof(double))));

struct ColumnTile {
  std::array<const double*, kLeft> left;
  std::array<const double*, kRight> right;
  std::array<double, kLeft * kRight> products{};
};

// Adds to the products what `rows` rows from `first` have. Written out: as loops over a tile's
// columns GCC 12 keeps the sums in memory, at a third of the speed.
TRIBENCH_EACH_LEVEL void add_rows(ColumnTile& tile, Index first, Index rows) {
  const double* a0 = tile.left[0] + first;
  const double* a1 = tile.left[1] + first;
  const double* a2 = tile.left[2] + first;
  const double* a3 = tile.left[3] + first;
  const double* b0 = tile.right[0] + first;
  const double* b1 = tile.right[1] + first;
  Sums s00 = {};
  Sums s01 = {};
  Sums s10 = {};
  Sums s11 = {};
  Sums s20 = {};
  Sums s21 = {};
  Sums s30 = {};
  Sums s31 = {};
  const Index whole = rows - rows % kPartialSums;
  for (Index r = 0; r < whole; r += kPartialSums) {
    Sums x;
    Sums y;
    Sums a;
    std::memcpy(&x, b0 + r, sizeof x);
    std::memcpy(&y, b1 + r, sizeof y);
    std::memcpy(&a, a0 + r, sizeof a);
    s00 += a * x;
    s01 += a * y;
    std::memcpy(&a, a1 + r, sizeof a);
    s10 += a * x;
    s11 += a * y;
    std::memcpy(&a, a2 + r, sizeof a);
    s20 += a * x;
    s21 += a * y;
    std::memcpy(&a, a3 + r, sizeof a);
    s30 += a * x;
    s31 += a * y;
  }
  const Sums all[kLeft * kRight] = {s00, s01, s10, s11, s20, s21, s30, s31};
  for (Index k = 0; k < kLeft * kRight; ++k) {
    const Sums& s = all[k];
    tile.products[static_cast<std::size_t>(k)] +=
        ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
  }
  for (Index r = first + whole; r < first + rows; ++r) {
    for (std::size_t k = 0; k < tile.products.size(); ++k) {
      tile.products[k] += tile.left[k / kRight][r] * tile.right[k % kRight][r];
    }
  }
}

// Columns i... of a and j... of b; where they end, the last ones stand for those that are not
// there.
ColumnTile tile_at(const ColumnsRef& a, Index i, const ColumnsRef& b, Index j) {
  ColumnTile tile;
  for (Index k = 0; k < kLeft; ++k) {
    tile.left[static_cast<std::size_t>(k)] = a.col(std::min(i + k, a.cols() - 1)).data();
  }
  for (Index k = 0; k < kRight; ++k) {
    tile.right[static_cast<std::size_t>(k)] = b.col(std::min(j + k, b.cols() - 1)).data();
  }
  return tile;
}

void write(const ColumnTile& tile, Index i, Index j, Eigen::MatrixXd& out) {
  for (Index k = 0; k < std::min(kLeft, out.rows() - i); ++k) {
    for (Index l = 0; l < std::min(kRight, out.cols() - j); ++l) {
      out(i + k, j + l) = tile.products[static_cast<std::size_t>(k * kRight + l)];
    }
  }
}

// The tiles that `is_wanted(i, j)`, each block of rows for all of them while it is in the cache.
template <typename IsWanted>
Eigen::MatrixXd products(const ColumnsRef& a, const ColumnsRef& b, IsWanted is_wanted) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  struct Placed {
    Index i;
    Index j;
    ColumnTile tile;
  };
  std::vector<Placed> tiles;
  for (Index i = 0; i < a.cols(); i += kLeft) {
    for (Index j = 0; j < b.cols(); j += kRight) {
      if (is_wanted(i, j)) tiles.push_back({i, j, tile_at(a, i, b, j)});
    }
  }
  for (Index row = 0; row < a.rows(); row += kRowsAtOnce) {
    const Index rows = std::min(kRowsAtOnce, a.rows() - row);
    for (Placed& one : tiles) add_rows(one.tile, row, rows);
  }
  for (const Placed& one : tiles) write(one.tile, one.i, one.j, out);
  return out;
}

constexpr Index kSubtracted = 8;  // columns that a row is read and written once for

// to[r] -= sum of x[k][r] c[k].
TRIBENCH_EACH_LEVEL void subtract_columns(double* to,
                                          const std::array<const double*, kSubtracted>& x,
                                          const std::array<double, kSubtracted>& c, Index rows) {
  const auto [x0, x1, x2, x3, x4, x5, x6, x7] = x;
  const auto [c0, c1, c2, c3, c4, c5, c6, c7] = c;
  for (Index r = 0; r < rows; ++r) {
    const double first = (x0[r] * c0 + x1[r] * c1) + (x2[r] * c2 + x3[r] * c3);
    const double second = (x4[r] * c4 + x5[r] * c5) + (x6[r] * c6 + x7[r] * c7);
    to[r] -= first + second;
  }
}

}  // namespace

Eigen::MatrixXd cross_products(const ColumnsRef& a, const ColumnsRef& b) {
  return products(a, b, [](Index, Index) { return true; });
}

Eigen::MatrixXd gram_of(const ColumnsRef& a) {
  Eigen::MatrixXd gram = products(a, a, [](Index i, Index j) { return j + kRight > i; });
  gram.triangularView<Eigen::StrictlyLower>() = gram.transpose();
  return gram;
}

Eigen::MatrixXd less_combination(Eigen::MatrixXd from, const ColumnsRef& columns,
                                 const ColumnsRef& coefficients) {
  const Index p = columns.cols();
  for (Index row = 0; row < from.rows(); row += kRowsAtOnce) {
    const Index rows = std::min(kRowsAtOnce, from.rows() - row);
    for (Index j = 0; j < from.cols(); ++j) {
      for (Index k = 0; k < p; k += kSubtracted) {
        std::array<const double*, kSubtracted> x;
        std::array<double, kSubtracted> c{};
        for (Index i = 0; i < kSubtracted; ++i) {
          x[static_cast<std::size_t>(i)] = columns.col(std::min(k + i, p - 1)).data() + row;
          if (k + i < p) c[static_cast<std::size_t>(i)] = coefficients(k + i, j);
        }
        subtract_columns(from.col(j).data() + row, x, c, rows);
      }
    }
  }
  return from;
}

}  // namespace tribench::loop
