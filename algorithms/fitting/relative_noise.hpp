// SPDX-License-Identifier: MIT
//
// Whether noise grows in proportion with what is measured, as that of most instruments over decades
// does. Least squares then looks at the largest rows alone, and evidence that takes all rows for
// equally sure pays dozens of operations for what is noise there.
//
// Two likelihoods of the same rows, normal with one standard deviation or with one that is in
// proportion with the formula's value, are compared over all of a front: each kind of noise is
// spoken for by the formula that has the most evidence under it.
//
// Not for noise that is told (--sigma), nor for a law that goes through 0 within the rows: there
// noise in proportion would have to vanish.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// One over the square of the value of the formula that speaks best for noise in proportion, where
// that explains the rows better than noise of one size by 10 nats and by a tenth of a nat a row;
// else none, and none where a formula is exact. front: its constants fitted; finite rows. Cost: an
// evaluation a formula.
std::optional<std::vector<double>> weights_of_relative_noise(std::span<const Expression> front,
                                                             const Inputs& inputs,
                                                             std::span<const double> target);

// Whether what a formula leaves, over its value, is not alike where the inputs are alike: else the
// law is not found, and what is left says nothing of noise. Compares ranks, of each row and the one
// nearest to it, by three standard errors. Finite rows; of at most 1000 of them, O(rows^2 inputs).
bool leaves_only_noise(const Expression& formula, const Inputs& inputs,
                       std::span<const double> target);

}  // namespace tribench
