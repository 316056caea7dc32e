// SPDX-License-Identifier: MIT
//
// Columns of independent standard normal numbers.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "foundation/random.hpp"

namespace tribench::testing {

inline Eigen::MatrixXd normal_columns(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXd out(rows, columns);
  for (double& x : out.reshaped()) x = random.normal();
  return out;
}

}  // namespace tribench::testing
