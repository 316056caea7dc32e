// SPDX-License-Identifier: MIT
#include "algorithms/expression/column_kernels.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "foundation/random.hpp"

namespace tribench::columns {
namespace {

std::vector<double> random_values(std::size_t n, RandomStream random) {
  std::vector<double> values(n);
  for (double& value : values) value = random.normal();
  return values;
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
