// SPDX-License-Identifier: MIT
#include "algorithms/parfam/formula.hpp"

#include <cmath>

#include "algorithms/expression/build.hpp"

namespace tribench::parfam {
namespace {

using namespace build;

class FormulaWriter {
 public:
  FormulaWriter(const TrainedModel& model, std::span<const double> scales,
                Denominators denominators, const OperatorSet& operators)
      : model_(model), scales_(scales), denominators_(denominators), operators_(operators) {
    for (std::size_t j = 0; j < model.structure.inputs; ++j) variables_.push_back(input(j));
  }

  Expression write() {
    const Structure& structure = model_.structure;
    std::size_t next = 0;
    std::vector<Expression> functions;
    for (std::size_t i = 0; i < structure.functions.size(); ++i) {
      const Expression top = polynomial(structure.numerators[i], model_.inner, next);
      next += structure.numerators[i].size();
      const Expression u = over(top, structure.denominators[i], next);
      next += structure.denominators[i].size();
      functions.push_back(apply(structure.functions[i], u));
    }
    variables_.insert(variables_.end(), functions.begin(), functions.end());
    const Expression top = polynomial(structure.out_numerator, model_.coefficients, 0);
    return over(top, structure.out_denominator, next);
  }

 private:
  Expression polynomial(const std::vector<Monomial>& monomials, std::span<const double> values,
                        std::size_t begin) const {
    std::vector<double> coefficients;
    for (std::size_t k = 0; k < monomials.size(); ++k) {
      double coefficient = values[begin + k];
      for (std::size_t j = 0; j < model_.structure.inputs; ++j) {
        for (int e = 0; e < monomials[k][j]; ++e) coefficient /= scales_[j];
      }
      coefficients.push_back(coefficient);
    }
    const Expression result = polynomial_formula(monomials, coefficients, variables_);
    return result.empty() ? constant(0) : result;
  }

  Expression over(const Expression& top, const std::vector<Monomial>& denominator,
                  std::size_t begin) const {
    if (denominator.empty()) return top;
    const Expression q = polynomial(denominator, model_.inner, begin);
    const bool safe = denominators_ == Denominators::safe;
    return top / (constant(1) + (safe ? power(q, 2) : q));
  }

  Expression apply(Op op, const Expression& u) const {
    if (op == Op::sqrt || op == Op::log) return function(op, magnitude(u, operators_));
    return function(op, u);
  }

  const TrainedModel& model_;
  std::span<const double> scales_;
  Denominators denominators_;
  const OperatorSet& operators_;
  std::vector<Expression> variables_;
};

}  // namespace

Expression magnitude(const Expression& u, const OperatorSet& operators) {
  return operators.allows(Op::abs) ? function(Op::abs, u) : function(Op::sqrt, power(u, 2));
}

Expression formula_of(const TrainedModel& model, std::span<const double> scales,
                      Denominators denominators, const OperatorSet& operators) {
  return FormulaWriter(model, scales, denominators, operators).write();
}

}  // namespace tribench::parfam
