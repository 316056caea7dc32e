// SPDX-License-Identifier: MIT
//
// Fits the constants of a formula to data by Levenberg-Marquardt with exact derivatives; those that
// enter linearly are solved for exactly at every step (variable projection).
// The one place where constants are optimised: search, polish and baselines all come here.
// Not a global optimiser: it converges to a minimum near where it starts.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"

namespace tribench {

// none: they are part of the form; not_simple: those that a fit has found (free_constants.hpp).
enum class FitExponents { none, not_simple, all };

struct ConstantFitOptions {
  int max_iterations = 30;
  double gradient_tolerance = 1e-10;  // cosine between the residual and a column of J
  double step_tolerance = 1e-10;      // relative to the constants
  double function_tolerance = 1e-8;   // relative decrease of the sum of squares
  // Constants that are the exponent of ^ move too.
  FitExponents exponents = FitExponents::none;
  // Bounds on the constants that are fitted, in the order of the tape; empty for none. The
  // constants given must keep to them.
  std::span<const double> low = {};
  std::span<const double> high = {};
  InTime in_time = {};  // once it says no, the fit ends and leaves the constants as they were given
};

struct ConstantFitResult {
  FitStatus status = FitStatus::no_constants;
  double sum_squares = 0;  // at the constants returned
  int iterations = 0;
  std::uint64_t node_rows = 0;  // what the fit cost, Jacobians counted as evaluations of their cost
};

// Keeps its workspace between fits. One per thread.
class ConstantFitter {
 public:
  ConstantFitter();
  ~ConstantFitter();
  ConstantFitter(ConstantFitter&&) noexcept;
  ConstantFitter& operator=(ConstantFitter&&) noexcept;

  // Moves the constants of `formula` to a local minimum of sum_r w_r (f(r) - target[r])^2; leaves
  // the best constants seen, never worse ones than it was given. weights may be empty (all 1).
  // All of target and weights must be finite.
  ConstantFitResult fit(Expression& formula, const Inputs& inputs, std::span<const double> target,
                        std::span<const double> weights = {},
                        const ConstantFitOptions& options = {});

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace tribench
