// SPDX-License-Identifier: MIT
//
// A grid either is refused with a place, or prints as a grid of the same cells.
#include "harness/grid.hpp"
#include "algorithms/registry.hpp"
#include "problems/catalogue.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

// More cells than that are no fault, but take long to list.
constexpr std::uint64_t kMaxCells = 20'000;

std::uint64_t cell_count(const Grid& grid) {
  return grid.problems.size() * grid.methods.size() *
         std::max<std::size_t>(grid.operators.size(), 1) * grid.seed_count;
}

}  // namespace

TRIBENCH_FUZZ_TARGET(grid) {
  static const Registry registry;
  static const Catalogue catalogue;
  Grid grid;
  if (!fuzz::reads([&] { grid = parse_grid(input, "grid.toml", registry, catalogue); })) return;
  const std::string printed = print_grid(grid);
  const Grid again = parse_grid(printed, "printed.toml", registry, catalogue);
  fuzz::expect(print_grid(again) == printed, "the printed grid prints as another one");
  if (grid.seed_count > kMaxCells || cell_count(grid) > kMaxCells) return;
  const std::vector<Cell> before = grid.cells();
  const std::vector<Cell> after = again.cells();
  fuzz::expect(before.size() == after.size(), "the printed grid has other cells");
  for (std::size_t i = 0; i < before.size(); ++i) {
    fuzz::expect(before[i].key() == after[i].key(), "a cell has another key");
  }
}
