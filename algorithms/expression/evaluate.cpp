// SPDX-License-Identifier: MIT
#include "algorithms/expression/evaluate.hpp"

#include <algorithm>
#include <cmath>

namespace tribench {
namespace {

constexpr std::size_t kBlock = 256;
constexpr double kMaxProductPower = 64;

double integer_power(double base, int exponent) {
  double result = 1;
  double square = base;
  for (int n = std::abs(exponent); n > 0; n >>= 1) {
    if ((n & 1) != 0) result *= square;
    square *= square;
  }
  return exponent < 0 ? 1 / result : result;
}

double sign_of(double x) {
  if (x > 0) return 1;
  if (x < 0) return -1;
  return x == 0 ? 0 : x;
}

template <typename F>
void map(const double* a, double* out, std::size_t n, F f) {
  for (std::size_t i = 0; i < n; ++i) out[i] = f(a[i]);
}

template <typename F>
void map(const double* a, const double* b, double* out, std::size_t n, F f) {
  for (std::size_t i = 0; i < n; ++i) out[i] = f(a[i], b[i]);
}

void apply_unary(Op op, const double* a, double* out, std::size_t n) {
  switch (op) {
    case Op::neg:
      return map(a, out, n, [](double x) { return -x; });
    case Op::exp:
      return map(a, out, n, [](double x) { return std::exp(x); });
    case Op::log:
      return map(a, out, n, [](double x) { return std::log(x); });
    case Op::sqrt:
      return map(a, out, n, [](double x) { return std::sqrt(x); });
    case Op::abs:
      return map(a, out, n, [](double x) { return std::abs(x); });
    case Op::sgn:
      return map(a, out, n, sign_of);
    case Op::sin:
      return map(a, out, n, [](double x) { return std::sin(x); });
    case Op::cos:
      return map(a, out, n, [](double x) { return std::cos(x); });
    default:
      return map(a, out, n, [](double x) { return std::tanh(x); });
  }
}

bool is_product_power(const Node& exponent) {
  return exponent.is_constant() && std::abs(exponent.value) <= kMaxProductPower &&
         exponent.value == std::floor(exponent.value);
}

void apply_power(const double* a, const double* b, const Node& exponent, double* out,
                 std::size_t n) {
  if (is_product_power(exponent)) {
    const int power = static_cast<int>(exponent.value);
    return map(a, out, n, [power](double x) { return integer_power(x, power); });
  }
  map(a, b, out, n, [](double x, double y) { return std::pow(x, y); });
}

void apply_binary(Op op, const double* a, const double* b, double* out, std::size_t n) {
  switch (op) {
    case Op::add:
      return map(a, b, out, n, [](double x, double y) { return x + y; });
    case Op::sub:
      return map(a, b, out, n, [](double x, double y) { return x - y; });
    case Op::mul:
      return map(a, b, out, n, [](double x, double y) { return x * y; });
    default:
      return map(a, b, out, n, [](double x, double y) { return x / y; });
  }
}

}  // namespace

void Evaluator::evaluate(const Expression& formula, const Inputs& inputs, std::span<double> out) {
  workspace_.resize((formula.size() + 1) * kBlock);
  std::vector<const double*> stack;
  for (std::size_t row = 0; row < inputs.rows; row += kBlock) {
    const std::size_t n = std::min(kBlock, inputs.rows - row);
    stack.clear();
    for (std::size_t i = 0; i < formula.size(); ++i) {
      const Node& node = formula.node(i);
      double* slot = workspace_.data() + stack.size() * kBlock;
      if (node.is_variable()) {
        stack.push_back(inputs.columns[node.variable] + row);
      } else if (node.is_constant()) {
        std::fill_n(slot, n, node.value);
        stack.push_back(slot);
      } else if (arity(node.op) == 1) {
        slot -= kBlock;
        apply_unary(node.op, stack.back(), slot, n);
        stack.back() = slot;
      } else {
        slot -= 2 * kBlock;
        const double* right = stack.back();
        stack.pop_back();
        if (node.op == Op::pow) {
          apply_power(stack.back(), right, formula.node(i - 1), slot, n);
        } else {
          apply_binary(node.op, stack.back(), right, slot, n);
        }
        stack.back() = slot;
      }
    }
    std::copy_n(stack.back(), n, out.data() + row);
  }
}

double Evaluator::evaluate_at(const Expression& formula, std::span<const double> point) {
  std::vector<const double*> columns(point.size());
  for (std::size_t j = 0; j < point.size(); ++j) columns[j] = &point[j];
  double value = 0;
  evaluate(formula, {columns, 1}, {&value, 1});
  return value;
}

}  // namespace tribench
