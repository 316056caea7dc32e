// SPDX-License-Identifier: MIT
#include "algorithms/inference/column_products.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "algorithms/expression/column_kernels.hpp"

namespace tribench::loop {
namespace {

using Eigen::Index;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<const double*> columns_of(const ColumnsRef& matrix) {
  std::vector<const double*> columns;
  for (Index j = 0; j < matrix.cols(); ++j) columns.push_back(matrix.col(j).data());
  return columns;
}

}  // namespace

Eigen::MatrixXd cross_products(const ColumnsRef& a, const ColumnsRef& b) {
  RowMajor products(a.cols(), b.cols());
  columns::cross_products(columns_of(a).data(), static_cast<std::size_t>(a.cols()),
                          columns_of(b).data(), static_cast<std::size_t>(b.cols()),
                          static_cast<std::size_t>(a.rows()), products.data());
  return products;
}

Eigen::MatrixXd gram_of(const ColumnsRef& a) {
  Eigen::MatrixXd products(a.cols(), a.cols());
  columns::gram(columns_of(a).data(), static_cast<std::size_t>(a.cols()),
                static_cast<std::size_t>(a.rows()), products.data());
  return products;
}

Eigen::MatrixXd less_combination(Eigen::MatrixXd from, const ColumnsRef& columns,
                                 const ColumnsRef& coefficients) {
  constexpr Index kRowsAtOnce = 1024;  // of all columns stay in the cache
  const Eigen::MatrixXd taken_off = -coefficients;
  std::vector<const double*> rows = columns_of(columns);
  for (Index row = 0; row < from.rows(); row += kRowsAtOnce) {
    const Index count = std::min(kRowsAtOnce, from.rows() - row);
    for (Index j = 0; j < from.cols(); ++j) {
      columns::add_combination(rows.data(), taken_off.col(j).data(), rows.size(),
                               from.col(j).data() + row, static_cast<std::size_t>(count));
    }
    for (const double*& column : rows) column += count;
  }
  return from;
}

}  // namespace tribench::loop
