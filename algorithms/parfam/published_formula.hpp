// SPDX-License-Identifier: MIT
//
// What the published program prints for trained coefficients: denominators normalised, three
// decimals, exp without its clip. Not exactly what was trained; that is how it is published.
#pragma once

#include <span>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/parfam/family.hpp"

namespace tribench::parfam {

// Where abs is not allowed, |u| is written sqrt(u^2).
Expression published_formula(const Structure& structure, std::span<const double> theta,
                             const OperatorSet& operators);

}  // namespace tribench::parfam
