// SPDX-License-Identifier: MIT
//
// Exact derivatives of a formula over columns of data: with respect to its constants (the Jacobian
// of a fit) or to its inputs. Reverse mode, in blocks that stay in cache; the sums that least
// squares needs, J^T W J and J^T W r, are formed without storing J.
//
// Conventions where a derivative does not exist: sgn has derivative 0 everywhere, 0 included; |x|
// has sgn(x), which is 0 at 0. x^n with a constant whole |n| <= 64 has n x^(n-1) for every x; with
// respect to an exponent x^y has x^y log(x), NaN for x < 0. Everything else follows IEEE 754:
// sqrt at 0 has an infinite derivative, nothing is masked.
//
// Values agree with `Evaluator` to rounding. Results do not depend on threads. Cost: about 2 to 3
// evaluations for all derivatives together, plus p (p + 1) / 2 dot products for the sums.
//
// Source: reverse accumulation, Griewank & Walther 2008, chapter 3. A constant factor travels
// beside its column instead of being multiplied in, and a column that is only passed on is not
// copied, so that sums and products with constants cost nothing on the way back.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "algorithms/expression/derivative_block.hpp"
#include "algorithms/expression/derivative_plan.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// Whether there is time to go on; empty: always. Asked before every block of rows, for what takes
// seconds (the sums of hundreds of constants).
using InTime = std::function<bool()>;

// The sums of a weighted least-squares problem at one point, residual r = f - target.
struct NormalEquations {
  double sum_squares = 0;         // sum w r^2; not finite where the formula is not
  std::vector<double> gradient;   // J^T W r, p values
  std::vector<double> curvature;  // J^T W J, p x p, symmetric
};

// Keeps its workspace between formulas. One per thread.
class Differentiator {
 public:
  // Differentiate with respect to the constants at these places of the tape, each named once.
  void prepare(const Expression& formula, std::span<const std::size_t> constants);
  // Differentiate with respect to inputs 0 .. inputs - 1.
  void prepare_for_inputs(const Expression& formula, std::size_t inputs);

  std::size_t parameters() const { return plan_.parameters(); }
  // New values of the constants named in `prepare`, in that order.
  void set_constants(std::span<const double> values);

  // values[r] = f at row r.
  void evaluate(const Inputs& inputs, std::span<double> values);
  // jacobian[k * rows + r] = derivative of f at row r with respect to parameter k. values may be
  // empty where they are not wanted.
  void jacobian(const Inputs& inputs, std::span<double> values, std::span<double> jacobian);

  // sum_r w_r (f(r) - target[r])^2; weights may be empty (all 1). NaN where the time was too short.
  double sum_squares(const Inputs& inputs, std::span<const double> target,
                     std::span<const double> weights, const InTime& in_time = {});
  // All sums of least squares. Only after `prepare` with constants. Where the call before was
  // `sum_squares` with the same arguments and constants, its values are used again. The sum of
  // squares and the gradient are NaN where the time was too short.
  void normal_equations(const Inputs& inputs, std::span<const double> target,
                        std::span<const double> weights, NormalEquations& result,
                        const InTime& in_time = {});

 private:
  std::size_t begin_blocks(std::size_t rows);
  void write_values(double* out, std::size_t n) const;
  void write_jacobian(std::size_t row, std::size_t n, std::size_t rows, double* jacobian);
  double residuals(std::span<const double> target, std::span<const double> weights, std::size_t row,
                   std::size_t n);
  void accumulate(std::span<const double> weights, std::size_t row, std::size_t n,
                  NormalEquations& result);

  DerivativePlan plan_;
  DerivativeBlock block_;
  std::vector<const double*> summands_;
  std::vector<double> scales_;
  std::vector<bool> written_;
  bool values_are_current_ = false;
};

}  // namespace tribench
