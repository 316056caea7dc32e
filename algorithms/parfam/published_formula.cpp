// SPDX-License-Identifier: MIT
#include "algorithms/parfam/published_formula.hpp"

#include <cmath>

#include "algorithms/expression/build.hpp"
#include "algorithms/parfam/formula.hpp"
#include "algorithms/parfam/published_model.hpp"

namespace tribench::parfam {
namespace {

using namespace build;

constexpr double kDecimals = 1000;  // three of them

Expression rounded_polynomial(const std::vector<Monomial>& monomials,
                              std::span<const double> coefficients,
                              std::span<const Expression> variables) {
  std::vector<double> rounded;
  for (double c : coefficients) rounded.push_back(std::round(c * kDecimals) / kDecimals);
  const Expression result = polynomial_formula(monomials, rounded, variables);
  return result.empty() ? constant(0) : result;
}

}  // namespace

Expression published_formula(const Structure& structure, std::span<const double> theta,
                             const OperatorSet& operators) {
  std::vector<Expression> variables;
  for (std::size_t j = 0; j < structure.inputs; ++j) variables.push_back(input(j));
  std::size_t next = 0;
  const auto ratio = [&](const std::vector<Monomial>& top, const std::vector<Monomial>& bottom) {
    const Expression numerator =
        rounded_polynomial(top, theta.subspan(next, top.size()), variables);
    next += top.size();
    if (bottom.empty()) return numerator;
    std::vector<double> unit(theta.begin() + static_cast<std::ptrdiff_t>(next),
                             theta.begin() + static_cast<std::ptrdiff_t>(next + bottom.size()));
    next += bottom.size();
    normalise(unit);
    return numerator / rounded_polynomial(bottom, unit, variables);
  };
  std::vector<Expression> functions;
  for (std::size_t i = 0; i < structure.functions.size(); ++i) {
    const Op op = structure.functions[i];
    Expression u = ratio(structure.numerators[i], structure.denominators[i]);
    if (op == Op::sqrt) u = magnitude(u, operators);
    if (op == Op::log) u = magnitude(u, operators) + constant(kLogFloor);
    functions.push_back(function(op, u));
  }
  variables.insert(variables.end(), functions.begin(), functions.end());
  return ratio(structure.out_numerator, structure.out_denominator);
}

}  // namespace tribench::parfam
