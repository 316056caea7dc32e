// SPDX-License-Identifier: MIT
//
// BFGS with a line search to the strong Wolfe conditions, in SciPy's form: what SciPy's `minimize`
// runs where a method says no more than "BFGS". For the faithful modes; for sums of squares
// Levenberg-Marquardt needs far fewer evaluations, and NLopt's L-BFGS less work for an iteration.
//
// Source: Nocedal & Wright 2006, algorithms 6.1, 3.5 and 3.6, with SciPy 1.15's first step,
// curvature update and end (scipy/optimize/_optimize.py, _linesearch.py). We differ in the line
// search: SciPy tries that of More & Thuente first and this one where that fails.
//
// Memory n^2; an iteration costs n^2 and one or two evaluations.
#pragma once

#include <span>

#include "algorithms/fitting/objective.hpp"

namespace tribench {

struct BfgsOptions {
  int max_iterations = 200;
  double gradient_tolerance = 1e-5;  // of the largest component
  const bool* stop = nullptr;        // as in MinimizeOptions
};

// converged: the gradient is small; limit: iterations or the stop flag; failed: no step that
// descends (SciPy's precision loss) or no finite start.
Minimum minimize_bfgs(const Objective& objective, std::span<const double> start,
                      const BfgsOptions& options = {});

}  // namespace tribench
