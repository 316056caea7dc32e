// SPDX-License-Identifier: MIT
//
// A last look at a choice on few rows: evidence and posterior trust a formula's constants to the
// fits that found them, and with some dozen rows a form that a long search has found for them can
// be worse than their mean on others. Where cross-validation (cross_validation.hpp) says so
// plainly, the formula that it speaks for takes the place.
//
// Not for choosing in general: a factor of two is far beyond what folds differ by, so that
// elsewhere the methods' own choice stands. Not for exact formulas (exact_choice.hpp).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// More rows than this: the choice stands, and nothing is computed.
inline constexpr std::size_t kFewRows = 400;
// What is held out speaks plainly against a choice that errs so many times as much, squared.
inline constexpr double kPlainly = 2;

// `chosen`, or the place of the smallest held-out error where the chosen formula's is more than
// twice that, or above the target's variance. Errors are charged what a form gains by being
// searched on all rows, as the evidence charges nodes. Five folds; of at most 20 rows each alone.
// `front` by increasing complexity; movement[r] names the movement of row r, or is empty: each row
// is its own. Cost: a fit a formula and fold, some 20 ms for 20 formulas and 100 rows, seconds for
// long sums on 400; in_time is asked before each, and once it says no the choice stands.
std::size_t held_out_choice(std::span<const Expression> front, std::size_t chosen,
                            const Inputs& inputs, std::span<const double> target,
                            std::span<const int> movement,
                            const std::function<bool()>& in_time = {});

// A sum of few inputs, or the mean, where it stands better than `chosen` on rows held out from
// both (linear_sum.hpp), that of `chosen` charged as above and by the number of inputs that each of
// its leaves could be: the sum's were chosen without the rows held out. None where `chosen` stands,
// on more than kFewRows rows, on fewer than 12 and out of time. Cost: ten fits of the formula.
std::optional<Expression> plain_sum_instead(const Expression& chosen, const Inputs& inputs,
                                            std::span<const double> target,
                                            std::span<const int> movement,
                                            const std::function<bool()>& in_time = {});

}  // namespace tribench
