// SPDX-License-Identifier: MIT
//
// The description length of a fitted formula: what it takes to write down the formula, its
// constants to the precision the data deserve, and the residuals. Formulas of different size on
// the same data are compared by it; less is better.
//
//   k ln q  +  sum_i max(0, ln |theta_i| + 0.5 ln I_i - 0.5 ln 3)  +  (n / 2) ln(RSS / n)
//
// k nodes out of q different symbols; I_i is the Fisher information of constant i under Gaussian
// noise of the variance RSS / n, which is not known beforehand. Residuals are taken for
// independent.
//
// Source: Bartlett, Desmond & Ferreira 2023, eq. 6. We differ in that a constant the data do not
// determine costs nothing instead of being set to 0, and that the noise is profiled out.
#pragma once

#include <span>

#include "algorithms/expression/differentiate.hpp"

namespace tribench {

// In nats, up to a constant of the data; infinite where the formula is not finite. A residual below
// 1e-12 of the target's size counts as that. One evaluation with derivatives.
double description_length(const Expression& formula, const Inputs& inputs,
                          std::span<const double> target, Differentiator& differentiator);

}  // namespace tribench
