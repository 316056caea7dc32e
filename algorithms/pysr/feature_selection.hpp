// SPDX-License-Identifier: MIT
//
// Which inputs a search is shown, where there are more than it can handle: those that matter most
// to a random forest. Not a test of relevance: an input that acts through a product alone may rank
// low, and of two that say the same the first takes what both could.
//
// Source: Breiman 2001, "Random forests", with the importance of Breiman et al. 1984 (the fall of
// the squared error by the splits on an input); 100 trees of depth 3 and every input at every
// split, as PySR has it (pysr/feature_selection.py). Ours differs in that equal splits go to the
// first input, not to a drawn one, and in that the forest sees kForestRows rows at most.
#pragma once

#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/pysr/rows.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

inline constexpr std::size_t kForestRows = 10'000;

// Share of each of the first `inputs` columns in the forest's fall of squared error; they sum to 1,
// or are all 0 where no split helps. Empty where the budget does not reach: 300 passes over the
// rows of every input. O(trees * depth * inputs * rows).
std::vector<double> forest_importances(const Rows& rows, std::size_t inputs, RandomStream random,
                                       Budget& budget);

// The places of the `count` largest, increasing; of equals the first.
std::vector<std::size_t> most_important(std::span<const double> importances, std::size_t count);

}  // namespace tribench::pysr
