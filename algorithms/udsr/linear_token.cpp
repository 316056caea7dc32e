// SPDX-License-Identifier: MIT
#include "algorithms/udsr/linear_token.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/fitting/symmetric_system.hpp"

namespace tribench::udsr {
namespace {

// Relative to the Gram matrix's unit diagonal: lets collinear monomials share a coefficient
// instead of blowing up, and moves no well-determined coefficient in its tenth digit.
constexpr double kRidge = 1e-11;

void enumerate(std::span<const int> caps, int left, std::size_t at, Monomial& current,
               std::vector<Monomial>& all) {
  if (at == caps.size()) {
    all.push_back(current);
    return;
  }
  for (int e = 0; e <= std::min(left, caps[at]); ++e) {
    current[at] = static_cast<std::uint8_t>(e);
    enumerate(caps, left - e, at + 1, current, all);
  }
  current[at] = 0;
}

int degree_of(const Monomial& monomial) {
  int degree = 0;
  for (const std::uint8_t exponent : monomial) degree += exponent;
  return degree;
}

Expression product_of(const Monomial& monomial) {
  Expression product;
  for (std::size_t i = 0; i < monomial.size(); ++i) {
    if (monomial[i] == 0) continue;
    Expression factor = Expression::variable(i);
    if (monomial[i] > 1) {
      factor = Expression::binary(Op::pow, factor, Expression::constant(monomial[i]));
    }
    product = product.empty() ? factor : Expression::binary(Op::mul, product, factor);
  }
  return product;
}

}  // namespace

std::vector<Monomial> monomials(std::span<const int> caps, int degree) {
  std::vector<Monomial> all;
  Monomial current(caps.size(), 0);
  enumerate(caps, degree, 0, current, all);
  std::ranges::stable_sort(all, {}, degree_of);
  return all;
}

double monomial_count(std::span<const int> caps, int degree) {
  // counts[d]: monomials of total degree d in the inputs so far.
  std::vector<double> counts(static_cast<std::size_t>(degree) + 1, 0);
  counts[0] = 1;
  for (const int cap : caps) {
    for (int d = degree; d > 0; --d) {
      for (int e = 1; e <= std::min(cap, d); ++e) {
        counts[static_cast<std::size_t>(d)] += counts[static_cast<std::size_t>(d - e)];
      }
    }
  }
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}

Expression polynomial(std::span<const Monomial> terms, std::span<const double> coefficients) {
  Expression sum;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (coefficients[k] == 0) continue;
    const Expression product = product_of(terms[k]);
    Expression term = Expression::constant(coefficients[k]);
    if (!product.empty()) term = Expression::binary(Op::mul, term, product);
    sum = sum.empty() ? term : Expression::binary(Op::add, sum, term);
  }
  return sum.empty() ? Expression::constant(0) : sum;
}

Eigen::VectorXd column_of(const Monomial& monomial, std::span<const double* const> columns,
                          std::size_t rows) {
  const auto n = static_cast<Eigen::Index>(rows);
  Eigen::VectorXd column = Eigen::VectorXd::Ones(n);
  for (std::size_t i = 0; i < monomial.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXd> input(columns[i], n);
    for (int e = 0; e < monomial[i]; ++e) column.array() *= input.array();
  }
  return column;
}

PolynomialRegression::PolynomialRegression(std::span<const double* const> columns, std::size_t rows,
                                           std::span<const int> caps, int degree)
    : terms_(monomials(caps, degree)) {
  const auto n = static_cast<Eigen::Index>(rows);
  design_.resize(n, static_cast<Eigen::Index>(terms_.size()));
  scale_.resize(design_.cols());
  for (Eigen::Index k = 0; k < design_.cols(); ++k) {
    const Eigen::VectorXd column = column_of(terms_[static_cast<std::size_t>(k)], columns, rows);
    const double rms = std::sqrt(column.squaredNorm() / static_cast<double>(rows));
    scale_[k] = rms > 0 && std::isfinite(rms) ? rms : 1.0;
    design_.col(k) = column / scale_[k];
  }
  gram_ = design_.transpose() * design_;
}

PolynomialRegression::Normal PolynomialRegression::normal_equations(
    const Eigen::VectorXd& target, const Eigen::VectorXd& weights) const {
  Normal normal;
  if (weights.size() == 0) {
    normal = {gram_, design_.transpose() * target};
  } else {
    const Eigen::MatrixXd weighted = weights.asDiagonal() * design_;
    normal.gram = weighted.transpose() * weighted;
    normal.moment = weighted.transpose() * weights.cwiseProduct(target);
  }
  const double scale = normal.gram.diagonal().maxCoeff();
  normal.gram.diagonal().array() += kRidge * (scale > 0 ? scale : 1.0);
  return normal;
}

Eigen::VectorXd PolynomialRegression::solve(const Eigen::VectorXd& target,
                                            const Eigen::VectorXd& weights) const {
  const Normal normal = normal_equations(target, weights);
  const Eigen::VectorXd solution = solve_symmetric(normal.gram, normal.moment);
  return solution.cwiseQuotient(scale_);
}

}  // namespace tribench::udsr
