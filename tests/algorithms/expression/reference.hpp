// SPDX-License-Identifier: MIT
//
// Plain recursive evaluators that the fast ones are held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/kernels.hpp"

namespace tribench::reference {

template <typename T>
T product_power(T base, int exponent) {
  T result = 1;
  T square = base;
  for (int n = std::abs(exponent); n > 0; n >>= 1) {
    if ((n & 1) != 0) result *= square;
    square *= square;
  }
  return exponent < 0 ? T{1} / result : result;
}

// Whether the power at i is computed as a product of squares: its exponent is an operation on
// constants alone (or a constant) with a whole value.
inline bool has_no_variables(const Expression& formula, std::size_t i) {
  for (std::size_t k = formula.begin(i); k <= i; ++k) {
    if (formula.node(k).is_variable()) return false;
  }
  return true;
}

// The exact semantics, bit for bit: IEEE arithmetic in T, functions by the baseline kernels.
template <typename T>
T evaluate(const Expression& formula, std::size_t i, std::span<const T> point) {
  const Node& node = formula.node(i);
  if (node.op == Op::constant) return static_cast<T>(node.value);
  if (node.op == Op::variable) return point[node.variable];
  const KernelTable<T>& kernels = kernel_table<T>(VectorLevel::baseline);
  T a =
      evaluate(formula, arity(node.op) == 1 ? formula.last_child(i) : formula.left_child(i), point);
  T result = 0;
  if (arity(node.op) == 1) {
    if (node.op == Op::neg) return -a;
    if (node.op == Op::abs) return std::abs(a);
    if (node.op == Op::sqrt) return std::sqrt(a);
    kernels.function[static_cast<int>(node.op) - static_cast<int>(Op::neg)](&result, &a, nullptr,
                                                                            nullptr, 1);
    return result;
  }
  const std::size_t right = formula.last_child(i);
  T b = evaluate(formula, right, point);
  switch (node.op) {
    case Op::add:
      return a + b;
    case Op::sub:
      return a - b;
    case Op::mul:
      return a * b;
    case Op::div:
      return a / b;
    default:
      break;
  }
  if (has_no_variables(formula, right) && is_product_power(static_cast<double>(b))) {
    return product_power(a, static_cast<int>(b));
  }
  kernels.power[kFormVV](&result, &a, &b, nullptr, 1);
  return result;
}

// A value by the C library, and how far from it an evaluator may be that errs by up to 4 ulp in
// every operation (to first order, with a margin).
struct Bounded {
  double value = 0;
  double slack = 0;
};

inline double function_slack(Op op, double x, double slack, double value) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (slack == 0) return 0;
  switch (op) {
    case Op::exp:
      return slack < 1 ? 2 * slack * value : kInfinity;
    case Op::log:
      return slack < 0.5 * std::abs(x) ? 2 * slack / std::abs(x) : kInfinity;
    case Op::sqrt:
      return slack < 0.5 * std::abs(x) ? slack / std::sqrt(std::abs(x)) : kInfinity;
    case Op::sgn:
      return slack < std::abs(x) ? 0 : kInfinity;
    default:
      return slack;  // the others have slopes within +-1
  }
}

inline double apply_function(Op op, double x) {
  switch (op) {
    case Op::neg:
      return -x;
    case Op::exp:
      return std::exp(x);
    case Op::log:
      return std::log(x);
    case Op::sqrt:
      return std::sqrt(x);
    case Op::abs:
      return std::abs(x);
    case Op::sgn:
      return x > 0 ? 1 : (x < 0 ? -1 : (x == 0 ? 0 : x));
    case Op::sin:
      return std::sin(x);
    case Op::cos:
      return std::cos(x);
    case Op::atan:
      return std::atan(x);
    default:
      return std::tanh(x);
  }
}

inline Bounded apply_operation(Op op, Bounded a, Bounded b, bool product) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (op) {
    case Op::add:
      return {a.value + b.value, a.slack + b.slack};
    case Op::sub:
      return {a.value - b.value, a.slack + b.slack};
    case Op::mul:
      return {a.value * b.value,
              a.slack * std::abs(b.value) + b.slack * std::abs(a.value) + a.slack * b.slack};
    case Op::div: {
      const double value = a.value / b.value;
      if (b.slack == 0) return {value, a.slack == 0 ? 0 : a.slack / std::abs(b.value)};
      if (b.slack >= 0.5 * std::abs(b.value)) return {value, kInfinity};
      return {value, 2 * (a.slack + std::abs(value) * b.slack) / std::abs(b.value)};
    }
    default:
      break;
  }
  const double value =
      product ? product_power(a.value, static_cast<int>(b.value)) : std::pow(a.value, b.value);
  if (a.slack == 0 && b.slack == 0) return {value, 0};
  const double relative = std::abs(b.value) * a.slack / std::abs(a.value) +
                          b.slack * std::abs(std::log(std::abs(a.value)));
  return {value, relative < 0.1 && b.slack == 0 ? 2 * relative * std::abs(value) : kInfinity};
}

// The slack of an operation's result from `through`, what its operands' slack makes of it. A value
// that is not finite is certain (slack 0) where the operands are, or where it is NaN well inside a
// place without values; else anything may happen (infinite).
inline double total_slack(Op op, double value, double through, bool operands_exact) {
  if (operands_exact && !std::isfinite(value)) return 0;
  if (std::isnan(through)) return std::numeric_limits<double>::infinity();
  if (std::isnan(value)) return std::isfinite(through) ? 0 : through;
  if (std::isinf(value)) return std::numeric_limits<double>::infinity();
  if (op == Op::neg || op == Op::abs || op == Op::sgn) return through;
  return through + 4 * (std::abs(value) * std::numeric_limits<double>::epsilon() +
                        std::numeric_limits<double>::denorm_min());
}

inline Bounded evaluate_bounded(const Expression& formula, std::size_t i,
                                std::span<const double> point) {
  const Node& node = formula.node(i);
  if (node.op == Op::constant) return {node.value, 0};
  if (node.op == Op::variable) return {point[node.variable], 0};
  Bounded result;
  bool exact = false;
  if (arity(node.op) == 1) {
    const Bounded a = evaluate_bounded(formula, formula.last_child(i), point);
    exact = a.slack == 0;
    result.value = apply_function(node.op, a.value);
    result.slack = function_slack(node.op, a.value, a.slack, result.value);
  } else {
    const std::size_t right = formula.last_child(i);
    const Bounded a = evaluate_bounded(formula, formula.left_child(i), point);
    const Bounded b = evaluate_bounded(formula, right, point);
    exact = a.slack == 0 && b.slack == 0;
    const bool product =
        node.op == Op::pow && has_no_variables(formula, right) && is_product_power(b.value);
    result = apply_operation(node.op, a, b, product);
  }
  result.slack = total_slack(node.op, result.value, result.slack, exact);
  return result;
}

}  // namespace tribench::reference
