// SPDX-License-Identifier: MIT
//
// How many nats it takes to tell the formula and then the data: what a noisy front is chosen by.
//
//   structure   k ln q, k nodes, q different symbols (all constants are one symbol), and ln|n| for
//               every exponent
//   parameters  ln|c_i| + ln(I_i) / 2 - ln(3) / 2 for every constant c_i that its Fisher
//               information I_i = sum_r (df/dc_i)^2 / s^2 tells from 0 (|c_i| >= sqrt(12 / I_i))
//   data        n / 2 (ln(2 pi s^2) + 1) with s^2 the mean squared error, the profile likelihood
//               of Gaussian noise
//
// Source: Bartlett, Desmond, Ferreira 2023, "Exhaustive symbolic regression". We differ in the
// noise: theirs is given, ours is each formula's own, corrected for the constants it fits,
// s^2 = SSE / (n - p), and never below the rounding of the target. A formula with n <= p has no
// description length.
#pragma once

#include <optional>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/pysr/rows.hpp"

namespace tribench::pysr {

// Nats that a node costs in the evidence. Of 0.5, 0.75, 1, 1.5 and 2 the one with the lowest error
// of truth on averaged dataset A, joints 2 and 4, and on friction1d (10 to 20 seeds each).
inline constexpr double kNodePrice = 0.5;

// Nats; none where the formula or a derivative is not finite or n <= p. Keeps nothing between
// calls but `workspace`.
std::optional<double> description_length(const Expression& formula, const Rows& rows,
                                         Differentiator& workspace);

// The evidence for a formula, as nats against it: n / 2 ln(s^2) + p / 2 ln n + k / 2, with p
// numbers that its shape leaves to be chosen (dimension.hpp) and k nodes, exponents not among them.
// The Bayesian information criterion (Schwarz 1978) with a prior that falls by exp(-1/2) with every
// node. Needs no derivatives. `zero_loss` is the mean square of the target, which sets what counts
// as rounding.
//
// Against the description length it charges a constant ln(n) / 2 whatever its size and units, and
// a node 1/2 instead of ln q: the latter is the price of a formula typed by chance, which is more
// than what the formulas of mechanics carry.
double evidence_against(const Expression& formula, double mean_square, double zero_loss,
                        std::size_t rows);

// The part of it that does not depend on the loss: p / 2 ln n + k / 2.
double evidence_price(const Expression& formula, std::size_t rows);

}  // namespace tribench::pysr
