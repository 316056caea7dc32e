// SPDX-License-Identifier: MIT
//
// Which formula to stand for where the rows have no noise to speak of: the shortest of those that
// explain them to rounding. Evidence and posterior weigh errors against each other however small
// they are; between 1e-9 and 1e-12 of the target that compares how far constants were polished.
//
// A formula that meets the few largest rows of a target over many decades, and those alone, is none
// of them: nine tenths of the rows, those nearest to the median, count by themselves too.
//
// Nor is one that has nearly as many numbers as there are rows: what is left after each number has
// met a row has to say more, in nats, than it took to choose the form out of all of its length.
//
// Where the best formula leaves more than kNearlyExact of the target there is noise, or the law was
// not found, and there is no such choice: see posterior_choice.hpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// Root mean square of what is left, of the target's own about its mean.
inline constexpr double kNearlyExact = 1e-8;

// The place of the formula of least complexity (the paper's, then nodes; the first of equals) whose
// error is at most a hundred times the best one's, or 1e-9; none where the best one's is above
// kNearlyExact, the target is constant, or no formula is finite. One evaluation a formula.
std::optional<std::size_t> simplest_exact(std::span<const Expression> formulas,
                                          const Inputs& inputs, std::span<const double> target);

}  // namespace tribench
