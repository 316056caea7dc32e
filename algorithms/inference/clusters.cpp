// SPDX-License-Identifier: MIT
#include "algorithms/inference/clusters.hpp"

#include <algorithm>

namespace tribench::loop {
namespace {

constexpr double kStretchRows = 30;
constexpr double kStretchTimes = 10;
constexpr int kFolds = 10;
constexpr int kFoldsOfOneMovement = 5;

void cut(Clusters& clusters, std::size_t m, double rows_per_stretch) {
  const RowRange range = clusters.movements[m];
  const auto pieces = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(range.size()) / rows_per_stretch));
  for (std::size_t k = 0; k < pieces; ++k) {
    clusters.stretches.push_back(
        {range.begin + range.size() * k / pieces, range.begin + range.size() * (k + 1) / pieces});
    clusters.movement_of.push_back(m);
  }
}

void assign_folds(Clusters& clusters) {
  const std::size_t movements = clusters.movements.size();
  if (movements == 1) {
    const auto n = static_cast<int>(clusters.stretches.size());
    clusters.folds = std::min(kFoldsOfOneMovement, n);
    for (int c = 0; c < n; ++c) clusters.fold_of.push_back(c * clusters.folds / n);
    return;
  }
  clusters.folds = std::min(kFolds, static_cast<int>(movements));
  for (const std::size_t m : clusters.movement_of) {
    clusters.fold_of.push_back(static_cast<int>(m) % clusters.folds);
  }
}

}  // namespace

std::vector<RowRange> movement_ranges(std::span<const int> movement) {
  std::vector<RowRange> ranges;
  for (std::size_t i = 0; i < movement.size(); ++i) {
    if (i == 0 || movement[i] != movement[i - 1]) ranges.push_back({i, i});
    ranges.back().end = i + 1;
  }
  return ranges;
}

Clusters make_clusters(std::span<const int> movement, double correlation_time) {
  Clusters clusters;
  clusters.rows = movement.size();
  clusters.movements = movement_ranges(movement);
  const double rows_per_stretch = std::max(kStretchRows, kStretchTimes * correlation_time);
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) cut(clusters, m, rows_per_stretch);
  assign_folds(clusters);
  return clusters;
}

}  // namespace tribench::loop
