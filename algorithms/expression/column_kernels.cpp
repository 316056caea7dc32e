// SPDX-License-Identifier: MIT
#include "algorithms/expression/column_kernels.hpp"

#include <algorithm>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/expression/vector/kernels.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench::columns {
namespace {

// The evaluator's own kernels, so that values and derivatives meet bit for bit.
const KernelTable<double>& kernels() {
  static const KernelTable<double>& table = kernel_table<double>(vector_level());
  return table;
}

void apply(Op function, const double* a, double* out, std::size_t n) {
  kernels().function[static_cast<int>(function) - static_cast<int>(Op::neg)](out, a, nullptr,
                                                                             nullptr, n);
}

void combine(Op operation, OperandForm form, const double* a, const double* b, double* out,
             std::size_t n) {
  kernels().binary[static_cast<int>(operation) - static_cast<int>(Op::add)][form](out, a, b,
                                                                                  nullptr, n);
}

}  // namespace

void add(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::add, kFormVV, a, b, out, n);
}
void add(const double* a, double b, double* out, std::size_t n) {
  combine(Op::add, kFormVS, a, &b, out, n);
}
void sub(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::sub, kFormVV, a, b, out, n);
}
void sub(double a, const double* b, double* out, std::size_t n) {
  combine(Op::sub, kFormSV, &a, b, out, n);
}
void mul(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::mul, kFormVV, a, b, out, n);
}
void mul(const double* a, double b, double* out, std::size_t n) {
  combine(Op::mul, kFormVS, a, &b, out, n);
}
void div(const double* a, const double* b, double* out, std::size_t n) {
  combine(Op::div, kFormVV, a, b, out, n);
}
void div(double a, const double* b, double* out, std::size_t n) {
  combine(Op::div, kFormSV, &a, b, out, n);
}
void div(const double* a, double b, double* out, std::size_t n) {
  combine(Op::div, kFormVS, a, &b, out, n);
}

void sqrt(const double* a, double* out, std::size_t n) { apply(Op::sqrt, a, out, n); }
void abs(const double* a, double* out, std::size_t n) { apply(Op::abs, a, out, n); }
void sgn(const double* a, double* out, std::size_t n) { apply(Op::sgn, a, out, n); }

void integer_power(const double* a, int exponent, double* out, std::size_t n) {
  if (exponent == 2) return combine(Op::mul, kFormVV, a, a, out, n);
  const double size = exponent;
  kernels().integer_power(out, a, &size, nullptr, n);
}

TRIBENCH_EACH_LEVEL void one_minus_square(const double* a, double* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = 1 - a[i] * a[i];
}

void exp(const double* a, double* out, std::size_t n) { apply(Op::exp, a, out, n); }
void log(const double* a, double* out, std::size_t n) { apply(Op::log, a, out, n); }
void sin(const double* a, double* out, std::size_t n) { apply(Op::sin, a, out, n); }
void cos(const double* a, double* out, std::size_t n) { apply(Op::cos, a, out, n); }
void tanh(const double* a, double* out, std::size_t n) { apply(Op::tanh, a, out, n); }
void atan(const double* a, double* out, std::size_t n) { apply(Op::atan, a, out, n); }
void pow(const double* a, const double* b, double* out, std::size_t n) {
  kernels().power[kFormVV](out, a, b, nullptr, n);
}

TRIBENCH_EACH_LEVEL void add_combination(const double* const* columns, const double* coefficients,
                                         std::size_t count, double* out, std::size_t n) {
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {
    const double* a = columns[j];
    const double* b = columns[j + 1];
    const double* c = columns[j + 2];
    const double* d = columns[j + 3];
    const double ca = coefficients[j];
    const double cb = coefficients[j + 1];
    const double cc = coefficients[j + 2];
    const double cd = coefficients[j + 3];
    for (std::size_t i = 0; i < n; ++i) {
      out[i] += (ca * a[i] + cb * b[i]) + (cc * c[i] + cd * d[i]);
    }
  }
  for (; j < count; ++j) {
    const double* a = columns[j];
    const double ca = coefficients[j];
    for (std::size_t i = 0; i < n; ++i) out[i] += ca * a[i];
  }
}

void combine(const double* const* columns, const double* coefficients, std::size_t count,
             double* out, std::size_t n) {
  std::fill(out, out + n, 0.0);
  add_combination(columns, coefficients, count, out, n);
}

}  // namespace tribench::columns
