// SPDX-License-Identifier: MIT
#include "algorithms/inference/column_products.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/algorithms/inference/normal_columns.hpp"

namespace tribench::loop {
namespace {

using testing::normal_columns;

bool have_same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

// Eight sums of every eighth row, 512 rows at a time, one number after the other.
double in_the_stated_order(const double* a, const double* b, Eigen::Index rows) {
  double product = 0;
  for (Eigen::Index first = 0; first < rows; first += 512) {
    const Eigen::Index count = std::min<Eigen::Index>(512, rows - first);
    const Eigen::Index whole = count - count % 8;
    double s[8] = {};
    double rest = 0;
    for (Eigen::Index r = 0; r < whole; ++r) s[r % 8] += a[first + r] * b[first + r];
    for (Eigen::Index r = whole; r < count; ++r) rest += a[first + r] * b[first + r];
    product += (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))) + rest;
  }
  return product;
}

TEST(ColumnProducts, AreSumsInOneOrderWhateverTheProcessor) {
  for (const Eigen::Index rows : {0, 1, 7, 8, 9, 511, 512, 513, 3007}) {
    for (const Eigen::Index p : {1, 2, 3, 4, 5, 11}) {
      const Eigen::MatrixXd a = normal_columns(rows, p, 1);
      const Eigen::MatrixXd b = normal_columns(rows, 3, 2);
      Eigen::MatrixXd expected(p, 3);
      for (Eigen::Index i = 0; i < p; ++i) {
        for (Eigen::Index j = 0; j < 3; ++j) {
          expected(i, j) = in_the_stated_order(a.col(i).data(), b.col(j).data(), rows);
        }
      }
      EXPECT_TRUE(have_same_bits(cross_products(a, b), expected)) << rows << " x " << p;
    }
  }
}

TEST(ColumnProducts, OfAGramMatrixAreThoseOfTheColumnsWithThemselvesAndSymmetric) {
  for (const Eigen::Index p : {1, 2, 3, 4, 5, 6, 7, 13}) {
    const Eigen::MatrixXd a = normal_columns(2050, p, 3);
    const Eigen::MatrixXd gram = gram_of(a);
    EXPECT_TRUE(have_same_bits(gram, cross_products(a, a))) << p;
    EXPECT_TRUE(have_same_bits(gram, gram.transpose())) << p;
  }
}

TEST(ColumnProducts, TakeRowsOfALargerMatrixAsTheyLie) {
  const Eigen::MatrixXd a = normal_columns(300, 6, 4);
  const Eigen::MatrixXd rows = a.middleRows(13, 250);
  EXPECT_TRUE(have_same_bits(gram_of(a.middleRows(13, 250)), gram_of(rows)));
}

TEST(ColumnProducts, ACombinationTakenOffLeavesWhatEigenLeaves) {
  for (const Eigen::Index p : {0, 1, 7, 8, 9, 20}) {
    const Eigen::MatrixXd columns = normal_columns(1500, p, 5);
    const Eigen::MatrixXd coefficients = normal_columns(p, 4, 6);
    const Eigen::MatrixXd from = normal_columns(1500, 4, 7);
    const Eigen::MatrixXd left = less_combination(from, columns, coefficients);
    EXPECT_LT((left - (from - columns * coefficients)).norm(), 1e-12 * from.norm()) << p;
  }
}

TEST(ColumnProducts, SpreadWhatIsNotFinite) {
  Eigen::MatrixXd a = normal_columns(40, 3, 8);
  a(17, 1) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd gram = gram_of(a);
  EXPECT_TRUE(std::isnan(gram(0, 1)) && std::isnan(gram(1, 1)) && std::isnan(gram(2, 1)));
  EXPECT_TRUE(std::isfinite(gram(0, 0)) && std::isfinite(gram(2, 0)));
}

}  // namespace
}  // namespace tribench::loop
