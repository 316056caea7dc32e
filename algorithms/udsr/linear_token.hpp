// SPDX-License-Identifier: MIT
//
// The linear token: a polynomial in the inputs whose coefficients are solved for by least squares
// on the target seen through the rest of the formula, inverted.
//
// Source: Landajuela et al. 2022, section 3.3. We differ: the rows are weighted by the derivative
// of what stands above the token, so that the error minimised is (to first order) the formula's
// own and not that of the inverted target; rows on which the inversion fails are left out instead
// of making the token the constant 1; an input that is a sign enters with degree one at most.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::udsr {

// A product of powers of inputs; exponents[i] belongs to input i.
using Monomial = std::vector<std::uint8_t>;

// All monomials of total degree <= degree with exponent i <= caps[i], the constant first, then by
// increasing degree.
std::vector<Monomial> monomials(std::span<const int> caps, int degree);

// How many these are, without making them: of 50 inputs and degree 6 there are 32 million.
double monomial_count(std::span<const int> caps, int degree);

// sum_k coefficients[k] * monomials[k] as a formula; terms with coefficient 0 are left out.
Expression polynomial(std::span<const Monomial> terms, std::span<const double> coefficients);

// The monomial's value on every row; columns[i]: the rows of input i.
Eigen::VectorXd column_of(const Monomial& monomial, std::span<const double* const> columns,
                          std::size_t rows);

class PolynomialRegression {
 public:
  // columns[i]: the rows of input i.
  PolynomialRegression(std::span<const double* const> columns, std::size_t rows,
                       std::span<const int> caps, int degree);

  const std::vector<Monomial>& terms() const { return terms_; }
  std::size_t rows() const { return static_cast<std::size_t>(design_.rows()); }

  // Minimises sum_r weights[r]^2 (polynomial(r) - target[r])^2; weights may be empty (all one).
  // Cost: O(rows * terms) without weights, O(rows * terms^2) with them.
  Eigen::VectorXd solve(const Eigen::VectorXd& target, const Eigen::VectorXd& weights) const;

 private:
  struct Normal {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
  };
  Normal normal_equations(const Eigen::VectorXd& target, const Eigen::VectorXd& weights) const;

  std::vector<Monomial> terms_;
  Eigen::MatrixXd design_;  // columns scaled to unit root mean square
  Eigen::VectorXd scale_;
  Eigen::MatrixXd gram_;  // of the unweighted design
};

}  // namespace tribench::udsr
