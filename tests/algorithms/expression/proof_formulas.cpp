// SPDX-License-Identifier: MIT
#include "tests/algorithms/expression/proof_formulas.hpp"

#include <array>
#include <cmath>

namespace tribench::testing {
namespace {

constexpr std::array kBinary = {Op::add, Op::sub, Op::mul, Op::div, Op::add, Op::mul};
constexpr std::array kUnary = {Op::neg, Op::exp, Op::log, Op::sqrt, Op::abs,
                               Op::sgn, Op::sin, Op::cos, Op::tanh, Op::atan};

Expression random_leaf(RandomStream& random, const FormulaKind& kind) {
  if (random.chance(0.6)) return Expression::variable(random.below(kind.inputs));
  if (kind.whole_constants) return Expression::constant(static_cast<double>(random.below(7)) - 3);
  return Expression::constant(std::round(3000 * random.normal()) / 1000);
}

// One draw a statement: compilers differ in which of a call's arguments they evaluate first.
Expression grow(RandomStream& random, const FormulaKind& kind, std::size_t operations) {
  if (operations == 0) return random_leaf(random, kind);
  if (random.chance(0.25)) {
    const Expression argument = grow(random, kind, operations - 1);
    return Expression::unary(kUnary[random.below(kUnary.size())], argument);
  }
  if (random.chance(0.12)) {
    const auto whole = static_cast<double>(random.below(7)) - 2;
    const double exponent = random.chance(0.2) ? whole / 2 : whole;
    const Expression base = grow(random, kind, operations - 1);
    return Expression::binary(Op::pow, base, Expression::constant(exponent));
  }
  const std::size_t left = random.below(operations);
  const Expression a = grow(random, kind, left);
  const Expression b = random.chance(0.1) ? a : grow(random, kind, operations - 1 - left);
  return Expression::binary(kBinary[random.below(kBinary.size())], a, b);
}

}  // namespace

Expression random_formula(RandomStream& random, const FormulaKind& kind) {
  return grow(random, kind, 1 + random.below(kind.max_operations));
}

bool is_finite_throughout(Evaluator& evaluator, const Expression& formula,
                          std::span<const double> point) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!std::isfinite(evaluator.evaluate_at(subtree(formula, i), point))) return false;
  }
  return true;
}

bool overflows(Evaluator& evaluator, const Expression& formula, std::span<const double> point) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const double value = evaluator.evaluate_at(subtree(formula, i), point);
    if (std::isfinite(value) && (std::abs(value) > 1e60 || (value != 0 && std::abs(value) < 1e-60)))
      return true;
  }
  return false;
}

}  // namespace tribench::testing
