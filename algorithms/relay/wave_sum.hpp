// SPDX-License-Identifier: MIT
//
// A wave of one input whose sizes the others set: y = b(x) + c(x) sin(w x_j) + d(x) cos(w x_j),
// with b, c and d sums of the inputs (of the others for c and d) and of 1. A ripple that grows with
// the load, a vibration with its amplitude among the inputs.
//
// One regression for every frequency of a grid as fine as the rows can tell, on some of the rows;
// the best are refined by golden sections, and what is exact loses the terms that it does without.
// Finds nothing where there is noise (product_search.hpp says why). Cost: some 30 ms for two
// inputs, 0.1 s for four; more are not looked at.
// Source of the grid: Lomb 1976, Scargle 1982; of regressions over it: generalised periodograms,
// Zechmeister and Kuerster 2009.
#pragma once

#include <optional>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Exact to rounding; none where none is.
std::optional<Expression> find_wave_sum(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget);

}  // namespace tribench::relay
