// SPDX-License-Identifier: MIT
//
// The denominators 1 + q of a structure at one point, with their derivatives by the inner
// parameters: what a constraint "no denominator reaches 0" is made of. For values over many rows
// see projection.hpp.
#pragma once

#include <span>

#include "algorithms/parfam/family.hpp"

namespace tribench::parfam {

// Of the functions' arguments that have one, in order, and then of the output if it has one.
std::size_t count_denominators(const Structure& structure);

// values[i]: denominator i at the point (scaled inputs), NaN or infinite where an argument is.
// jacobian[i * n + k] = dD_i / dinner_k with n inner parameters; not written where empty.
void denominators_at(const Structure& structure, std::span<const double> inner,
                     std::span<const double> point, std::span<double> values,
                     std::span<double> jacobian);

}  // namespace tribench::parfam
