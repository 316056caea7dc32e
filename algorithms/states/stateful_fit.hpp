// SPDX-License-Identifier: MIT
//
// Fits the constants of a formula and the parameters of the states that it reads, together: one
// Jacobian, the formula's derivatives by its constants and by the states (on the tape), these times
// the states' sensitivities by their parameters. Levenberg-Marquardt from where both stand: a local
// minimum, never worse than the start. For formulas that were found or written down with states of
// roughly known parameters; models of a known form have fit_separable and a grid of starts.
#pragma once

#include <cstddef>
#include <span>

#include "algorithms/states/state_column.hpp"
#include "algorithms/states/state_text.hpp"

namespace tribench {

// The rows to fit, all finite; non-owning.
struct StatefulRows {
  std::span<const double* const> columns;  // of the formula's inputs, first_state of them
  std::span<const double> target;
  MotionRows motion;                        // the whole recording, the same inputs
  std::span<const std::size_t> motion_row;  // where each row stands in it
};

struct StatefulFitFigures {
  double before = 0;  // sums of squared errors; infinite where the start has none
  double after = 0;
  int iterations = 0;
};

// Exponents stay. A parameter that must be above 0 moves by at most a factor of 100 either way.
StatefulFitFigures fit_stateful(StatefulFormula& formula, const StatefulRows& rows);

}  // namespace tribench
