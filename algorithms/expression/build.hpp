// SPDX-License-Identifier: MIT
//
// Formulas written as formulas: `input(0) * exp(constant(2) * input(1))`. For methods that write
// down a known form; search edits tapes instead. Each operation copies its operands.
#pragma once

#include <span>

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

}  // namespace tribench::build
