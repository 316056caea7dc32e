// SPDX-License-Identifier: MIT
//
// Levenberg-Marquardt on the normal equations of any sum of squares.
//
// The damping is relative to the squared norms of the Jacobian's columns, the largest seen so far
// (More 1978), so that the result does not depend on the units of the parameters; it follows the
// ratio of the decrease won to the decrease promised (Nielsen 1999), but falls faster where the
// quadratic model holds. A step counts only by its value: the parameters returned are the best
// seen, never worse than the start. Bounds are kept by projecting the step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/expression/differentiate.hpp"

namespace tribench {

enum class FitStatus {
  converged,  // gradient, step or decrease below tolerance
  max_iterations,
  out_of_time,  // the problem stopped it
  not_finite,   // the sum of squares or its derivatives are not finite at the start
  no_constants,
};

class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;
  // Not finite where the problem is not defined, or where the budget is spent.
  virtual double sum_squares(std::span<const double> x) = 0;
  // Sums at the point `sum_squares` was asked for last.
  virtual void normal_equations(NormalEquations& sums) = 0;
  // Whether another point may be asked for.
  virtual bool may_go_on() const { return true; }
};

struct LevenbergMarquardtOptions {
  int max_iterations = 30;
  double gradient_tolerance = 1e-10;  // cosine between the residual and a column of J
  double step_tolerance = 1e-10;      // relative to the parameters
  double function_tolerance = 1e-12;  // relative decrease of the sum of squares
  std::span<const double> low = {};   // bounds, empty for none
  std::span<const double> high = {};
};

struct LevenbergMarquardtResult {
  FitStatus status = FitStatus::no_constants;
  double sum_squares = 0;
  int iterations = 0;
};

// Keeps its workspace between runs. One per thread.
class LevenbergMarquardt {
 public:
  // Moves x, which must lie within the bounds.
  LevenbergMarquardtResult minimize(LeastSquaresProblem& problem, std::vector<double>& x,
                                    const LevenbergMarquardtOptions& options);
  // The sums at the x returned; for standard errors and the like.
  const NormalEquations& sums() const { return sums_; }

 private:
  bool update_sums(LeastSquaresProblem& problem);
  bool solve_for_step(std::span<const double> x, double damping,
                      const LevenbergMarquardtOptions& options);
  double promised_decrease() const;
  double largest_scaled_gradient() const;
  bool step_is_small(std::span<const double> x, double tolerance) const;
  bool is_held(std::size_t k, double x, const LevenbergMarquardtOptions& options) const;
  void iterate(LeastSquaresProblem& problem, std::vector<double>& x,
               const LevenbergMarquardtOptions& options, LevenbergMarquardtResult& result);

  NormalEquations sums_;
  std::vector<double> trial_;
  std::vector<double> column_norms_;  // largest squared norm seen of each column of J
  std::vector<double> factor_;
  std::vector<double> step_;
  std::vector<double> scale_;
};

}  // namespace tribench
