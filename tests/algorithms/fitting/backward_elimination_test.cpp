// SPDX-License-Identifier: MIT
#include "algorithms/fitting/backward_elimination.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {
namespace {

using Columns = std::vector<Eigen::Index>;

Eigen::MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, RandomStream& random) {
  Eigen::MatrixXd values(rows, columns);
  for (double& value : values.reshaped()) value = random.normal();
  return values;
}

TEST(BackwardElimination, KeepsWhatAnExactSumIsMadeOf) {
  RandomStream random(1);
  Eigen::MatrixXd columns = drawn(60, 12, random);
  columns.col(3) *= 1e150;  // of any size
  const Eigen::VectorXd target = 2 * columns.col(1) - 1e-154 * columns.col(3) + columns.col(8);
  EXPECT_EQ(backward_elimination(columns, target), (Columns{1, 3, 8}));
}

TEST(BackwardElimination, KeepsOfNoiseNextToNothing) {
  std::size_t too_many = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed);
    const Eigen::MatrixXd columns = drawn(100, 20, random);
    const Eigen::VectorXd noise = drawn(100, 1, random);
    const Columns kept = backward_elimination(columns, columns.col(4) + noise);
    EXPECT_EQ(std::ranges::count(kept, 4), 1) << seed;
    if (kept.size() > 1) ++too_many;
  }
  EXPECT_LE(too_many, 12u);  // 20 columns at p = 0.001 each and what searching adds
}

TEST(BackwardElimination, TakesOneOfColumnsThatDependOnOneAnother) {
  RandomStream random(1);
  Eigen::MatrixXd columns = drawn(40, 3, random);
  columns.col(2) = -3 * columns.col(0);
  EXPECT_EQ(backward_elimination(columns, columns.col(0)).size(), 1u);
  EXPECT_TRUE(backward_elimination(Eigen::MatrixXd::Zero(40, 2), columns.col(0)).empty());
}

}  // namespace
}  // namespace tribench
