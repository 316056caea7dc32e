// SPDX-License-Identifier: MIT
//
// A fit in which rows count more or less, by any method: the search sees each row in proportion to
// its weight (systematic sampling, as many rows as there are), then the constants of every formula
// of its front are fitted to all rows by weighted least squares, and one of them is chosen anew by
// its weighted error: the search took a row that it saw ten times for ten rows.
//
// Not for grids, whose methods are compared on the same rows.
#pragma once

#include <span>

#include "harness/run_cell.hpp"

namespace tribench {

// weights: of the squared residuals, one a training row, at least one above 0; the problem has one
// stage. Figures are of all rows, unweighted, as ever, but for the front's weighted errors. Throws
// Error (bad_input) naming the row of a weight that is negative.
CellResult fit_weighted(const Problem& problem, std::span<const double> weights,
                        const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened = {});

}  // namespace tribench
