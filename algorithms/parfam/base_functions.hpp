// SPDX-License-Identifier: MIT
//
// ParFam's base functions with their slopes, as the published program guards them and as they are.
//
//   published:  sqrt |u|,  min(exp u, e^10 + |u|),  log(|u| + 1e-6)
//   exact:      sqrt |u|,  exp u,                    log |u|
//
// sin, cos and tanh are the same in both. The published guards are in training only; what it
// exports is exp u and log(|u| + 1e-6). Ours exports what it trains.
#pragma once

#include <cstddef>

#include "algorithms/expression/expression.hpp"

namespace tribench::parfam {

enum class Convention { published, exact };
inline constexpr double kLogFloor = 1e-6;  // of the published logarithm

// values[r] = g(u[r]).
void apply_function(Op function, Convention convention, const double* u, double* values,
                    std::size_t rows);
// slopes[r] = g'(u[r]), given the values; 0 where |u| has a kink.
void function_slope(Op function, Convention convention, const double* u, const double* values,
                    double* slopes, std::size_t rows);

}  // namespace tribench::parfam
