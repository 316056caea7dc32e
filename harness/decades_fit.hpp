// SPDX-License-Identifier: MIT
//
// A fit of a target of one sign that lies over decades (rates of reactions, leakage, viscosities),
// as measured: noise there mostly grows with the target, least squares sees the largest rows alone,
// and a law like A exp(-b/T) has no chance against what fits these a little better. So a third of
// the budget searches the target's logarithm, in which such noise is of one size. What it finds
// enters only where the rows say that their noise is in proportion (weighted_fit.hpp).
//
// Not for grids, whose methods are compared on the same rows.
#pragma once

#include <span>
#include <vector>

#include "harness/run_cell.hpp"

namespace tribench {

// Finite values of one sign whose logarithms have a standard deviation of 1.7 at least: two thirds
// of them need a factor of 30.
bool lies_over_decades(std::span<const double> target);

// The problem has one stage. `weights` are those of choose_by_relative_noise. A law that is exact
// without noise ends it before the logarithm is looked at; a form of the user's (a template) is one
// of the target, not of its logarithm.
CellResult fit_over_decades(const Problem& problem, const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened, std::vector<double>& weights);

}  // namespace tribench
