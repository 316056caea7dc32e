// SPDX-License-Identifier: MIT
//
// Movements and noise that tests of this room make.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

inline constexpr std::size_t kMovements = 60;
inline constexpr std::size_t kRows = 50;
inline constexpr double kRho = 0.6;
inline constexpr double kBetween = 0.2;

inline Clusters many_movements() {
  std::vector<int> movement;
  for (std::size_t m = 0; m < kMovements; ++m) {
    movement.insert(movement.end(), kRows, static_cast<int>(m));
  }
  return make_clusters(movement, 1);
}

// AR(1) of unit variance, an offset a movement; odd movements are `louder`
// times as loud.
inline Eigen::VectorXd noise_of(RandomStream random, double louder) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(kMovements * kRows));
  for (std::size_t m = 0; m < kMovements; ++m) {
    const double offset = kBetween * random.normal();
    const double scale = m % 2 == 1 ? louder : 1.0;
    double x = random.normal();
    for (std::size_t i = 0; i < kRows; ++i) {
      if (i > 0) x = kRho * x + std::sqrt(1 - kRho * kRho) * random.normal();
      out[static_cast<Eigen::Index>(m * kRows + i)] = offset + scale * x;
    }
  }
  return out;
}

inline std::vector<int> movements_of(std::initializer_list<int> rows) {
  std::vector<int> movement;
  int m = 0;
  for (const int count : rows) {
    movement.insert(movement.end(), static_cast<std::size_t>(count), m++);
  }
  return movement;
}

// Rows of which `share` of the variance 1 is slow, `rho` in neighbouring rows; the rest is white.
inline Eigen::VectorXd slow_under_white(double share, double rho, Eigen::Index rows,
                                        RandomStream random) {
  Eigen::VectorXd out(rows);
  double slow = random.normal();
  for (double& row : out) {
    row = std::sqrt(share) * slow + std::sqrt(1 - share) * random.normal();
    slow = rho * slow + std::sqrt(1 - rho * rho) * random.normal();
  }
  return out;
}

}  // namespace tribench::loop
