// SPDX-License-Identifier: MIT
#include "algorithms/fitting/product_blocking.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "foundation/random.hpp"

namespace tribench {
namespace {

Eigen::MatrixXd product_of_many_rows() {
  constexpr Eigen::Index kRows = 3000;
  RandomStream random(5);
  Eigen::MatrixXd a(60, kRows);
  Eigen::MatrixXd b(kRows, 70);
  for (double& x : a.reshaped()) x = random.normal();
  for (double& x : b.reshaped()) x = random.normal();
  return a * b;
}

// As on machines with first caches of 48 and of 64 KiB.
TEST(ProductBlocking, GivesTheSameBitsWhateverTheCaches) {
  Eigen::setCpuCacheSizes(48 << 10, 2 << 20, 32 << 20);
  const Eigen::MatrixXd unpinned = product_of_many_rows();
  pin_product_blocking();
  const Eigen::MatrixXd first = product_of_many_rows();
  EXPECT_NE(unpinned, first) << "else there is nothing to pin";
  Eigen::setCpuCacheSizes(64 << 10, 512 << 10, 4 << 20);
  pin_product_blocking();
  EXPECT_EQ(product_of_many_rows(), first);
}

}  // namespace
}  // namespace tribench
