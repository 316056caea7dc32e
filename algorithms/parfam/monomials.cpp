// SPDX-License-Identifier: MIT
#include "algorithms/parfam/monomials.hpp"

#include <algorithm>
#include <numeric>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/complexity.hpp"

namespace tribench::parfam {
namespace {

using namespace build;

void extend(int left, std::size_t variable, std::span<const int> caps, Monomial& current,
            std::vector<Monomial>& result) {
  if (variable == caps.size()) {
    if (left == 0) result.push_back(current);
    return;
  }
  for (int e = std::min(left, caps[variable]); e >= 0; --e) {
    current[variable] = e;
    extend(left - e, variable + 1, caps, current, result);
  }
  current[variable] = 0;
}

struct Term {
  Monomial monomial;
  double coefficient;
};

// What writing variable^e costs in a product: the product, the variable, the power.
int factor_cost(const Expression& variable, int exponent) {
  return exponent == 0 ? 0 : 1 + paper_complexity(variable) + (exponent > 1 ? 1 : 0);
}

struct Factor {
  std::size_t variable = 0;
  int exponent = 0;
  int saved = 0;
};

// The factor whose taking out of all terms that hold it saves most.
Factor best_factor(std::span<const Term> terms, std::span<const Expression> variables) {
  Factor best;
  for (std::size_t j = 0; j < terms[0].monomial.size(); ++j) {
    for (const Term& candidate : terms) {
      const int exponent = candidate.monomial[j];
      if (exponent == 0) continue;
      int saved = -factor_cost(variables[j], exponent);
      for (const Term& term : terms) {
        if (term.monomial[j] < exponent) continue;
        saved += factor_cost(variables[j], term.monomial[j]) -
                 factor_cost(variables[j], term.monomial[j] - exponent);
      }
      if (saved > best.saved) best = {j, exponent, saved};
    }
  }
  return best;
}

Expression variable_power(const Expression& variable, int exponent) {
  return exponent == 1 ? variable : power(variable, exponent);
}

Expression single_term(const Term& term, std::span<const Expression> variables) {
  Expression result = constant(term.coefficient);
  for (std::size_t j = 0; j < term.monomial.size(); ++j) {
    if (term.monomial[j] == 0) continue;
    result = result * variable_power(variables[j], term.monomial[j]);
  }
  return result;
}

Expression factored(std::vector<Term> terms, std::span<const Expression> variables) {
  if (terms.empty()) return {};
  const Factor factor = terms.size() > 1 ? best_factor(terms, variables) : Factor{};
  if (factor.saved <= 0) {
    Expression result;
    for (const Term& term : terms) result = sum_of(result, single_term(term, variables));
    return result;
  }
  std::vector<Term> inside;
  std::vector<Term> outside;
  for (Term& term : terms) {
    if (term.monomial[factor.variable] < factor.exponent) {
      outside.push_back(std::move(term));
      continue;
    }
    term.monomial[factor.variable] = term.monomial[factor.variable] - factor.exponent;
    inside.push_back(std::move(term));
  }
  const Expression product = variable_power(variables[factor.variable], factor.exponent) *
                             factored(std::move(inside), variables);
  return sum_of(factored(std::move(outside), variables), product);
}

}  // namespace

std::vector<Monomial> monomials_up_to(int degree, std::span<const int> caps) {
  std::vector<Monomial> result;
  Monomial current(caps.size(), 0);
  for (int total = 0; total <= degree; ++total) extend(total, 0, caps, current, result);
  return result;
}

double monomial_count(int degree, std::span<const int> caps) {
  // of[d]: in the variables so far, of total degree d.
  std::vector<double> of(static_cast<std::size_t>(degree) + 1, 0);
  of[0] = 1;
  for (const int cap : caps) {
    for (std::size_t d = of.size(); d-- > 0;) {
      for (std::size_t e = 1; e <= std::min(d, static_cast<std::size_t>(cap)); ++e) {
        of[d] += of[d - e];
      }
    }
  }
  return std::accumulate(of.begin(), of.end(), 0.0);
}

std::vector<double> monomial_values(const Monomial& monomial,
                                    std::span<const double* const> columns, std::size_t rows) {
  std::vector<double> values(rows, 1.0);
  for (std::size_t j = 0; j < monomial.size(); ++j) {
    for (int e = 0; e < monomial[j]; ++e) {
      for (std::size_t row = 0; row < rows; ++row) values[row] *= columns[j][row];
    }
  }
  return values;
}

Expression polynomial_formula(std::span<const Monomial> monomials,
                              std::span<const double> coefficients,
                              std::span<const Expression> variables) {
  std::vector<Term> terms;
  for (std::size_t k = 0; k < monomials.size(); ++k) {
    if (coefficients[k] != 0) terms.push_back({monomials[k], coefficients[k]});
  }
  return factored(std::move(terms), variables);
}

}  // namespace tribench::parfam
