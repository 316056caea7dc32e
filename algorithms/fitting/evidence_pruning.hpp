// SPDX-License-Identifier: MIT
//
// A formula under noise with fewer numbers: constants that the rows cannot tell from 0, 1, -1, and
// exponents that they cannot tell from a multiple of a half or a third, become these, one by one
// and the others fitted again, as long as the evidence grows (evidence.hpp): every number that is
// free is worth ln(n) / 2 nats. What the formula linearised in its constants forecasts decides
// which is tried first, and that what promises less than is gained need not be (LeCun, Denker,
// Solla 1990; Hassibi, Stork 1993); where nothing is gained all are tried.
//
// Not for rows without noise, where finish.hpp names constants to rounding, and no search over
// forms: only what such a value makes of the form goes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// The formula itself where nothing can go or it is not finite on the rows. `spend` is told the
// node-rows of each fit; false ends with what there is.
// Cost: a fit of a few iterations for each number that goes, and for each constant and value once
// more; 10 ms for ten constants and 500 rows.
Expression pruned_by_evidence(const Expression& formula, const Inputs& inputs,
                              std::span<const double> target, const InputBox& box,
                              const std::function<bool(std::uint64_t)>& spend);

}  // namespace tribench
