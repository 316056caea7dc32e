// SPDX-License-Identifier: MIT
#include "algorithms/inference/clusters.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

std::vector<std::size_t> stretch_sizes(const Clusters& clusters) {
  std::vector<std::size_t> sizes;
  for (const RowRange& stretch : clusters.stretches) sizes.push_back(stretch.size());
  return sizes;
}

TEST(MakeClusters, CutsMovementsIntoStretchesThatAreLongEnough) {
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(stretch_sizes(make_clusters(movements_of({45, 59, 60, 100}), 1)),
            (Sizes{45, 59, 30, 30, 33, 33, 34}));
  // Ten correlation times where that is more than 30 rows.
  EXPECT_EQ(stretch_sizes(make_clusters(movements_of({100}), 3)), (Sizes{33, 33, 34}));
  EXPECT_EQ(stretch_sizes(make_clusters(movements_of({100}), 5)), (Sizes{50, 50}));
  EXPECT_EQ(stretch_sizes(make_clusters(movements_of({100}), 80)), (Sizes{100}));
}

TEST(MakeClusters, FoldsNeverCutAMovementUnlessThereIsOneAlone) {
  const Clusters many = make_clusters(movements_of({5, 5, 60, 5, 5, 5, 5, 5, 5, 5, 5, 5}), 1);
  EXPECT_EQ(many.folds, 10);
  EXPECT_EQ(many.fold_of, (std::vector<int>{0, 1, 2, 2, 3, 4, 5, 6, 7, 8, 9, 0, 1}));
  EXPECT_EQ(make_clusters(movements_of({5, 5, 5}), 1).folds, 3);
  const Clusters one = make_clusters(movements_of({300}), 1);
  EXPECT_EQ(one.folds, 5);
  EXPECT_EQ(one.fold_of, (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3, 4, 4}));
}

}  // namespace
}  // namespace tribench::loop
