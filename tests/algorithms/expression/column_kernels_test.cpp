// SPDX-License-Identifier: MIT
#include "algorithms/expression/column_kernels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::columns {
namespace {

std::vector<double> random_values(std::size_t n, RandomStream random) {
  std::vector<double> values(n);
  for (double& value : values) value = random.normal();
  return values;
}

// A row of eight lanes, added up in the order that column_kernels.cpp states.
double sum_of_lanes(const std::array<double, 8>& s) {
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

// sum_i a[i] b[i]: row of lanes k adds to chain k mod `chains`; (s0 + s1) + (s2 + s3) of four.
double in_the_stated_order(const std::vector<double>& a, const std::vector<double>& b,
                           std::size_t chains) {
  std::array<std::array<double, 8>, 4> s = {};
  const std::size_t whole = a.size() - a.size() % 8;
  for (std::size_t i = 0; i < whole; ++i) s[i / 8 % chains][i % 8] += a[i] * b[i];
  double rest = 0;
  for (std::size_t i = whole; i < a.size(); ++i) rest += a[i] * b[i];
  std::array<double, 8> all = s[0];
  for (std::size_t lane = 0; chains == 4 && lane < 8; ++lane) {
    all[lane] = (s[0][lane] + s[1][lane]) + (s[2][lane] + s[3][lane]);
  }
  return sum_of_lanes(all) + rest;
}

TEST(Sums, AreInOneOrderWhateverTheProcessor) {
  for (const std::size_t n : {0U, 1U, 7U, 8U, 9U, 31U, 32U, 33U, 63U, 1000U}) {
    const std::vector<double> a = random_values(n, RandomStream(1));
    const std::vector<double> ones(n, 1.0);
    EXPECT_EQ(sum(a.data(), n), in_the_stated_order(a, ones, 1)) << n;
    std::vector<std::vector<double>> b;
    for (std::uint64_t k = 0; k < 4; ++k) b.push_back(random_values(n, RandomStream(2 + k)));
    EXPECT_EQ(dot(a.data(), b[0].data(), n), in_the_stated_order(a, b[0], 4)) << n;
    const double* four[4] = {b[0].data(), b[1].data(), b[2].data(), b[3].data()};
    double sums[4];
    dot4(a.data(), four, n, sums);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(sums[k], in_the_stated_order(a, b[k], 1)) << n;
  }
}

TEST(AddProduct, IsTheSumOverTheInnerIndexInOrderBitForBitForAnyShape) {
  for (const std::size_t rows : {1U, 15U, 16U, 33U, 128U}) {
    for (const std::size_t count : {1U, 3U, 4U, 9U}) {
      constexpr std::size_t kInner = 7;
      const std::vector<double> a = random_values(rows * kInner, RandomStream(rows));
      const std::vector<double> b = random_values(kInner * count, RandomStream(count));
      std::vector<double> expected = random_values(rows * count, RandomStream(3));
      std::vector<double> out = expected;
      for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t i = 0; i < rows; ++i) {
          for (std::size_t k = 0; k < kInner; ++k) {
            expected[j * rows + i] += a[k * rows + i] * b[j * kInner + k];
          }
        }
      }
      add_product(a.data(), b.data(), rows, kInner, count, out.data());
      EXPECT_EQ(out, expected) << rows << " x " << count;
    }
  }
}

}  // namespace
}  // namespace tribench::columns
