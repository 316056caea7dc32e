// SPDX-License-Identifier: MIT
//
// Which rows are independent of which: movements, the stretches they are cut into (the clusters
// of every test) and the folds of cross-validation, which never cut a movement unless there is but
// one. Not what their noise is like: noise.hpp.
//
// Source: effective sizes as in the specification, section 3.1 to 3.3.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {

struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

// The rows of each movement: runs of equal numbers.
std::vector<RowRange> movement_ranges(std::span<const int> movement);

struct Clusters {
  std::vector<RowRange> movements;
  std::vector<RowRange> stretches;
  std::vector<std::size_t> movement_of;  // per stretch
  std::vector<int> fold_of;              // per stretch
  int folds = 0;
  std::size_t rows = 0;
  // Per movement: its rows count as if their noise were 1/weight times the usual; empty: all 1.
  std::vector<double> weight;
  double weight_of(std::size_t movement) const { return weight.empty() ? 1 : weight[movement]; }
};

// Stretches hold at least 30 rows and 10 correlation times (in rows); a shorter movement is one
// stretch. Ten folds of movements in turn, fewer where there are fewer movements; five folds
// of neighbouring stretches where there is one movement.
Clusters make_clusters(std::span<const int> movement, double correlation_time);

}  // namespace tribench::loop
