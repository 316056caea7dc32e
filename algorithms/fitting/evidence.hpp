// SPDX-License-Identifier: MIT
//
// The evidence for a fitted formula, as nats against it:
//
//   n / 2 (ln(2 pi s^2) + 1)  +  p / 2 ln n  +  price k
//
// s^2 the mean squared error of n rows, p the numbers that the formula's shape leaves to be chosen
// (shape_dimension.hpp), k its nodes, whole exponents not among them. The Bayesian information
// criterion (Schwarz 1978) with a prior over structures that falls by exp(-price) with every node.
// Needs no derivatives. Residuals are taken for independent.
//
// Against the description length (description_length.hpp) it charges a constant ln(n) / 2 whatever
// its size and units, and a node no more than the prior says: ln q is the price of a formula typed
// by chance, which is more than what the formulas of mechanics carry.
#pragma once

#include <cstddef>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// What a node costs in nats where a search chooses formulas node by node. Of 0.5, 0.75, 1, 1.5 and
// 2 the one with the lowest error of truth on averaged dataset A, joints 2 and 4, and on friction1d
// (10 to 20 seeds each); on 25 other draws of each and of planted friction laws 0.5 is no worse
// than 0 and 0.25.
inline constexpr double kNodePrice = 0.5;

// `zero_loss` is the mean square of the target, which sets what counts as rounding.
double evidence_against(const Expression& formula, double mean_square, double zero_loss,
                        std::size_t rows, double node_price = kNodePrice);

// The part of it that does not depend on the loss.
double evidence_price(const Expression& formula, std::size_t rows, double node_price = kNodePrice);

}  // namespace tribench
