// SPDX-License-Identifier: MIT
//
// A fit in which rows count more or less, by any method: half of the budget goes to a search that
// sees each row in proportion to its weight (systematic sampling, as many rows as there are), half
// to one that sees all rows of any weight once. The constants of every formula of both fronts are
// fitted to all rows by weighted least squares, and one of them is chosen anew by its weighted
// error: a search takes a row that it sees ten times for ten rows. Weights over decades leave few
// rows to the first search, and the second looks at the largest errors alone: the law is found by
// the one or by the other.
//
// Not for grids, whose methods are compared on the same rows.
#pragma once

#include <span>
#include <vector>

#include "harness/run_cell.hpp"

namespace tribench {

// weights: of the squared residuals, one a training row, at least one above 0; the problem has one
// stage. Figures are of all rows, unweighted, as ever, but for the front's weighted errors. Throws
// Error (bad_input) naming the row of a weight that is negative.
CellResult fit_weighted(const Problem& problem, std::span<const double> weights,
                        const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened = {});

// The constants of a result's front fitted to all rows by these weights, and the formula chosen
// anew, as above; the problem has one stage.
void choose_by_weights(const Problem& problem, std::span<const double> weights,
                       const CellTask& task, CellResult& result);

// The same by the weights that noise in proportion with the target asks for, where the rows say so
// (fitting/relative_noise.hpp); the note tells. `further` are beside the front then. Returns the
// weights; none where nothing was done.
std::vector<double> choose_by_relative_noise(const Problem& problem, const CellTask& task,
                                             CellResult& result,
                                             std::span<const Expression> further = {});

}  // namespace tribench
