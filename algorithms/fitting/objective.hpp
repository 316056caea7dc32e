// SPDX-License-Identifier: MIT
//
// What every general minimiser here takes and returns, so that one can be exchanged for another.
// Not for sums of squares of a formula's residuals: Levenberg-Marquardt (constant_fit.hpp) uses
// their structure and needs far fewer evaluations.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace tribench {

// Value at x; writes the gradient where it is asked for (gradient not empty). May return NaN or
// infinity where the objective is not defined: a minimiser then goes elsewhere.
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

// low[i] <= x[i] <= high[i]; empty means unbounded.
struct Bounds {
  std::vector<double> low;
  std::vector<double> high;
};

enum class MinimizeStatus {
  converged,  // a tolerance of the minimiser is met
  limit,      // evaluations or the stop flag ended it
  failed,     // the minimiser gave up (rounding, line search, no finite value)
};

struct Minimum {
  std::vector<double> x;  // the best point seen; the start where no value was finite
  double value = std::numeric_limits<double>::infinity();
  MinimizeStatus status = MinimizeStatus::failed;
  std::uint64_t evaluations = 0;
};

struct MinimizeOptions {
  std::uint64_t max_evaluations = 10000;
  double value_tolerance = 1e-12;     // relative
  double position_tolerance = 1e-10;  // relative
  std::uint64_t seed = 1;             // of minimisers that draw random numbers
  // Set by the objective when the budget is spent: the minimiser then returns soon. May be null.
  const bool* stop = nullptr;
};

// A minimiser from a start, with everything else bound.
using LocalMinimizer = std::function<Minimum(std::span<const double> start)>;

}  // namespace tribench
