// SPDX-License-Identifier: MIT
//
// `branch_polynomial`: a cubic in velocity for each direction, fitted exactly by least squares:
//
//   tau = (a0 + b0 s) + (a1 + b1 s) v + (a2 + b2 s) v^2 + (a3 + b3 s) v^3  [+ M a]
//
// A strong baseline without any search: with the sign of velocity as an input, products of v and s
// are just this. A term that the data do not determine is left out.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry branch_polynomial_entry();

}  // namespace tribench
