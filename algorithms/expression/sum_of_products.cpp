// SPDX-License-Identifier: MIT
#include "algorithms/expression/sum_of_products.hpp"

#include <cmath>
#include <utility>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

void add_factors(const Expression& formula, std::size_t i, int power, SumTerm& term) {
  const Node& node = formula.node(i);
  if (node.op == Op::mul || node.op == Op::div) {
    add_factors(formula, formula.left_child(i), power, term);
    add_factors(formula, formula.last_child(i), node.op == Op::mul ? power : -power, term);
    return;
  }
  if (node.op == Op::neg) {
    if (power % 2 != 0) term.coefficient = -term.coefficient;
    add_factors(formula, formula.last_child(i), power, term);
    return;
  }
  if (node.op == Op::pow && formula.node(i - 1).is_constant()) {
    const double exponent = formula.node(i - 1).value * power;
    if (formula.node(i - 1).value > 0 && exponent != 0 && is_product_power(exponent) &&
        is_product_power(formula.node(i - 1).value)) {
      return add_factors(formula, formula.left_child(i), static_cast<int>(exponent), term);
    }
  }
  multiply_by(term, {subtree(formula, i), power});
}

void add_terms(const Expression& formula, std::size_t i, double sign, SumOfProducts& sum) {
  const Node& node = formula.node(i);
  if (is_sum(node.op)) {
    add_terms(formula, formula.left_child(i), sign, sum);
    add_terms(formula, formula.last_child(i), node.op == Op::add ? sign : -sign, sum);
    return;
  }
  if (node.op == Op::neg) return add_terms(formula, formula.last_child(i), -sign, sum);
  SumTerm term{sign, {}};
  add_factors(formula, i, 1, term);
  sum.push_back(std::move(term));
}

}  // namespace

Expression power_of(const Expression& base, int power) {
  return power == 1 ? base : build::power(base, power);
}

void multiply_by(SumTerm& term, TermFactor factor) {
  if (factor.base.size() == 1 && factor.base.node(0).is_constant()) {
    const double value = apply(Op::pow, factor.base.node(0).value, factor.power);
    if (std::isfinite(term.coefficient * value) && value != 0) {
      term.coefficient *= value;
      return;
    }
  }
  for (TermFactor& each : term.factors) {
    if (each.base == factor.base && (each.power > 0) == (factor.power > 0)) {
      each.power += factor.power;
      return;
    }
  }
  term.factors.push_back(std::move(factor));
}

SumTerm product_of(const SumTerm& a, const SumTerm& b) {
  SumTerm product = a;
  product.coefficient *= b.coefficient;
  for (const TermFactor& factor : b.factors) multiply_by(product, factor);
  return product;
}

SumOfProducts sum_of_products(const Expression& formula, std::size_t i) {
  SumOfProducts sum;
  add_terms(formula, i, 1, sum);
  return sum;
}

Expression formula_of(const SumTerm& term) {
  Expression above;
  Expression below;
  for (const TermFactor& factor : term.factors) {
    Expression& side = factor.power > 0 ? above : below;
    const Expression power = power_of(factor.base, std::abs(factor.power));
    side = side.empty() ? power : Expression::binary(Op::mul, side, power);
  }
  if (above.empty()) {
    above = Expression::constant(term.coefficient);
  } else if (term.coefficient == -1) {
    above = Expression::unary(Op::neg, above);
  } else if (term.coefficient != 1) {
    above = Expression::binary(Op::mul, Expression::constant(term.coefficient), above);
  }
  return below.empty() ? above : Expression::binary(Op::div, above, below);
}

Expression formula_of(const SumOfProducts& sum) {
  Expression formula;
  for (const SumTerm& term : sum) {
    SumTerm positive = term;
    positive.coefficient = std::abs(term.coefficient);
    if (formula.empty()) {
      formula = formula_of(term);
    } else {
      formula = Expression::binary(term.coefficient < 0 ? Op::sub : Op::add, formula,
                                   formula_of(positive));
    }
  }
  return formula;
}

}  // namespace tribench
