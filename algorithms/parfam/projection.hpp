// SPDX-License-Identifier: MIT
//
// Our form of the parametric family, with the output's numerator eliminated: for given inner
// parameters (the functions' arguments and the denominators) the model is linear in the rest, which
// is solved exactly, so that a search moves in 3 to 15 dimensions instead of 15 to 50.
//
//   f = sum_k c_k m_k(x, g_1(u_1), ...) / D(x, g),   u_i = N_i(x) / D_i(x)
//
// Denominators: `safe` ones are 1 + q^2 with q the polynomial, positive by construction; `free`
// ones are 1 + q without q's constant, and may have poles; `constrained` ones are free ones that
// pole_guard.hpp keeps from 0.
//
// Source: Golub & Pereyra 1973 with Kaufman's approximation 1975 of the projected Jacobian, from
// the normal equations of scaled columns; a column that depends on those before it (to 1e-11 of
// its square) gets coefficient 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"
#include "algorithms/fitting/objective.hpp"
#include "algorithms/parfam/base_functions.hpp"
#include "algorithms/parfam/monomial_columns.hpp"

namespace tribench::parfam {

enum class Denominators { safe, free, constrained };

// Keeps its workspace. One per thread.
class Projection : public LeastSquaresProblem {
 public:
  // inputs and y must outlive the projection. Every evaluation is taken from the budget first;
  // without budget the sum of squares is NaN.
  Projection(const Structure& structure, std::span<const double* const> inputs,
             std::span<const double> y, Denominators denominators, Budget& budget);

  const Structure& structure() const { return structure_; }
  std::size_t inner_parameters() const { return inner_count_; }
  std::size_t rows() const { return rows_; }

  // Residual sum of squares with the best linear coefficients. NaN where not finite.
  double sum_squares(std::span<const double> inner) override;
  // Sums of the projected problem at the inner parameters evaluated last.
  void normal_equations(NormalEquations& sums) override;
  // c_k of the evaluation last made.
  std::span<const double> coefficients() const { return coefficients_; }

  // J^T J of all parameters together, linear first, then inner, at the point evaluated last.
  std::vector<double> joint_curvature();

 private:
  struct Argument {  // of a function
    std::vector<const double*> numerator;
    std::vector<const double*> denominator;
    std::size_t begin = 0;  // place among the inner parameters
    std::vector<double> top;
    std::vector<double> q;  // of the denominator
    std::vector<double> bottom;
    std::vector<double> value;
    std::vector<double> g;
  };

  void evaluate_arguments(std::span<const double> inner);
  void evaluate_out_denominator(std::span<const double> inner);
  void make_basis();
  bool solve_linear();
  void make_jacobian();
  void write_inner_columns(const Argument& argument, std::span<const double> weight);
  void write_out_denominator_columns();
  double* jacobian_column(std::size_t k) { return jacobian_.data() + k * rows_; }

  Structure structure_;
  std::size_t rows_;
  std::span<const double> y_;
  Denominators denominators_;
  Budget& budget_;
  MonomialColumns columns_;
  std::vector<Argument> arguments_;
  std::vector<const double*> factors_;  // their functions' values, g
  std::vector<MonomialGroup> numerator_groups_;
  std::vector<MonomialGroup> denominator_groups_;
  std::size_t denominator_begin_ = 0;
  std::size_t inner_count_ = 0;
  std::uint64_t pass_cost_ = 0;
  std::vector<double> inner_;   // evaluated last
  std::vector<double> bottom_;  // the output's denominator
  std::vector<double> q_;
  std::vector<double> basis_memory_;
  std::vector<const double*> basis_;  // one column per linear coefficient, then y
  std::vector<double> gram_;
  std::vector<double> factor_;
  std::vector<char> kept_;
  std::vector<double> coefficients_;
  std::vector<double> fitted_;
  std::vector<double> residual_;
  std::vector<double> jacobian_;
  std::vector<double> space_;
  std::vector<double> weight_;
  std::vector<double> part_;
  std::vector<double> slope_;
  std::vector<double> cross_;
  std::vector<double> values_;
};

// The sum of squares as a general minimiser wants it. `stop` is set when the budget is spent; all
// three must outlive the objective.
Objective projected_objective(Projection& projection, const Budget& budget, bool& stop);

}  // namespace tribench::parfam
