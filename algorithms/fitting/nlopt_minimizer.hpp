// SPDX-License-Identifier: MIT
//
// NLopt's minimisers behind the common objective. Source: S. G. Johnson, the NLopt library;
// L-BFGS after Nocedal 1980, SLSQP after Kraft 1994, MLSL after Rinnooy Kan & Timmer 1987, CRS2
// after Price 1983, ISRES after Runarsson & Yao 2005, ESCH after da Silva Santos et al. 2010,
// DIRECT-L after Gablonsky & Kelley 2001.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "algorithms/fitting/objective.hpp"

namespace tribench {

enum class NloptMethod { lbfgs, slsqp, truncated_newton, mlsl, crs2, esch, isres, direct_l };

// "lbfgs", "slsqp", "truncated_newton", "mlsl", "crs2", "esch", "isres", "direct_l".
std::string_view nlopt_method_name(NloptMethod method);
// Global methods search the whole box and need finite bounds.
bool is_global(NloptMethod method);

// The best point seen, whatever NLopt returns. Random numbers are seeded from options.seed, so
// equal calls give equal results, in any thread. Throws Error (failed) where a global method is
// given no finite bounds. Thread-safe.
Minimum minimize_nlopt(NloptMethod method, const Objective& objective,
                       std::span<const double> start, const Bounds& bounds = {},
                       const MinimizeOptions& options = {});

}  // namespace tribench
