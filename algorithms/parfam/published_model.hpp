// SPDX-License-Identifier: MIT
//
// The published program's parametric model and loss, for the faithful mode: every coefficient is a
// parameter, denominators are divided by their 2-norm, |D| < 1e-5 is replaced by 1e-5, the values
// of the base functions are rounded to single precision.
//
//   L(theta) = ||f(X) - y||_2 / ||y||_2 + lambda ||theta||_1
//
// Source: parfam 0.0.2, parfam_torch.py. Gradients pass through the rounding as if it were not
// there, and not through a guarded denominator, as its automatic differentiation does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/parfam/base_functions.hpp"
#include "algorithms/parfam/monomial_columns.hpp"

namespace tribench::parfam {

struct PublishedModelOptions {
  bool single_precision_hidden = true;
  double denominator_floor = 1e-5;
};

// Divides a denominator's coefficients by their 2-norm; leaves zeros alone.
void normalise(std::span<double> coefficients);

// Keeps its workspace. One per thread.
class PublishedModel {
 public:
  PublishedModel(const Structure& structure, std::span<const double* const> inputs,
                 std::size_t rows, const PublishedModelOptions& options = {});

  std::size_t parameters() const { return structure_.parameters(); }
  std::size_t rows() const { return rows_; }
  // f at all rows; valid until the next call.
  std::span<const double> evaluate(std::span<const double> theta);
  // gradient[k] = sum_r seed[r] df(r)/dtheta_k at the theta evaluated last.
  void pull_back(std::span<const double> seed, std::span<double> gradient);
  // The loss; its gradient where asked for. y must not be all 0.
  double loss(std::span<const double> theta, std::span<const double> y, double lambda,
              std::span<double> gradient);

  // What one evaluation with its gradient costs, in node-rows.
  std::uint64_t cost() const { return 4 * parameters() * rows_; }

 private:
  // A ratio of polynomials, in the inputs (a function's argument) or with functions (the output).
  struct Rational {
    std::vector<MonomialGroup> numerator;
    std::vector<MonomialGroup> denominator;  // empty: 1
    std::size_t numerator_begin = 0;         // places in theta
    std::size_t denominator_begin = 0;
    std::size_t denominator_size = 0;
    std::vector<double> unit;  // normalised coefficients
    double norm = 1;
    std::vector<double> top;     // values per row
    std::vector<double> bottom;  // after the guard
    std::vector<double> value;
    std::vector<char> guarded;
  };

  void evaluate_ratio(Rational& ratio, std::span<const double> theta);
  void add_groups(const std::vector<MonomialGroup>& groups, const double* coefficients,
                  std::vector<double>& values);
  void pull_ratio(Rational& ratio, std::span<const double> seed, std::span<double> gradient);
  void pull_groups(const std::vector<MonomialGroup>& groups, const double* coefficients,
                   std::span<const double> seed, double* gradient);
  // Product of the functions of a group, without one of them where `without` names it.
  const double* product_of(unsigned functions, std::size_t without, std::vector<double>& space);

  Structure structure_;
  std::size_t rows_;
  PublishedModelOptions options_;
  MonomialColumns columns_;
  std::vector<Rational> inner_;
  Rational output_;
  std::vector<std::vector<double>> function_values_;
  std::vector<std::vector<double>> function_seeds_;
  std::vector<double> theta_;  // evaluated last
  std::vector<double> coefficients_;
  std::vector<double> sum_;
  std::vector<double> product_;
  std::vector<double> weighted_;
  std::vector<double> slope_;
  std::vector<double> numerator_seed_;
  std::vector<double> denominator_seed_;
  std::vector<double> residual_;
};

}  // namespace tribench::parfam
