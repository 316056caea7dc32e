// SPDX-License-Identifier: MIT
//
// Formulas written as formulas: `input(0) * exp(constant(2) * input(1))`. For methods that write
// down a known form; search edits tapes instead. Each operation copies its operands.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::build {

inline Expression constant(double value) { return Expression::constant(value); }
inline Expression input(std::size_t column) { return Expression::variable(column); }

inline Expression operator+(const Expression& a, const Expression& b) {
  return Expression::binary(Op::add, a, b);
}
inline Expression operator-(const Expression& a, const Expression& b) {
  return Expression::binary(Op::sub, a, b);
}
inline Expression operator*(const Expression& a, const Expression& b) {
  return Expression::binary(Op::mul, a, b);
}
inline Expression operator/(const Expression& a, const Expression& b) {
  return Expression::binary(Op::div, a, b);
}
inline Expression operator-(const Expression& a) { return Expression::unary(Op::neg, a); }
inline Expression power(const Expression& a, double exponent) {
  return Expression::binary(Op::pow, a, constant(exponent));
}
inline Expression function(Op op, const Expression& a) { return Expression::unary(op, a); }

// a + b, where an empty formula stands for nothing.
inline Expression sum_of(const Expression& a, const Expression& b) {
  if (a.empty()) return b;
  return b.empty() ? a : a + b;
}

// The formula with inputs[j] in place of input j.
inline Expression substituted(const Expression& formula, std::span<const Expression> inputs) {
  std::vector<Node> tape;
  for (const Node& node : formula.nodes()) {
    if (!node.is_variable()) {
      tape.push_back(node);
      continue;
    }
    const auto nodes = inputs[node.variable].nodes();
    tape.insert(tape.end(), nodes.begin(), nodes.end());
  }
  return Expression(std::move(tape));
}

}  // namespace tribench::build
