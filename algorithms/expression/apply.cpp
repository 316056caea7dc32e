// SPDX-License-Identifier: MIT
#include "algorithms/expression/apply.hpp"

#include <cmath>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/vector/kernels.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

const KernelTable<double>& kernels() {
  static const KernelTable<double>& table = kernel_table<double>(vector_level());
  return table;
}

}  // namespace

double apply(Op function, double a) {
  double result = 0;
  kernels().function[static_cast<int>(function) - static_cast<int>(Op::neg)](&result, &a, nullptr,
                                                                             nullptr, 1);
  return result;
}

double apply(Op operation, double a, double b) {
  switch (operation) {
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
  if (!is_product_power(b)) return elementary::pow(a, b);
  double result = 0;
  kernels().integer_power(&result, &a, &b, nullptr, 1);
  return result;
}

}  // namespace tribench
