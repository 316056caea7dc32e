// SPDX-License-Identifier: MIT
//
// The way back: from the adjoint of the root to those of the leaves. Every node of a tree has one
// parent, so an adjoint is written once and never added to.
#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/expression/differentiate.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

double scalar_derivative(Op op, double a, double v) {
  switch (op) {
    case Op::neg:
      return -1;
    case Op::exp:
      return v;
    case Op::log:
      return 1 / a;
    case Op::sqrt:
      return 0.5 / v;
    case Op::abs:
      return std::isnan(a) ? a : static_cast<double>(a > 0) - static_cast<double>(a < 0);
    case Op::sin:
      return elementary::cos(a);
    case Op::cos:
      return -elementary::sin(a);
    case Op::tanh:
      return 1 - v * v;
    default:
      return 0;
  }
}

}  // namespace

// adjoint * column; written to `out` only where both are columns. `out` may be `column`.
Differentiator::Adjoint Differentiator::times(const Adjoint& adjoint, const double* column,
                                              double* out, std::size_t n) {
  if (adjoint.data == nullptr) return {column, adjoint.scale};
  columns::mul(adjoint.data, column, out, n);
  return {out, adjoint.scale};
}

Differentiator::Adjoint Differentiator::over(const Adjoint& adjoint, const double* column,
                                             double* out, std::size_t n) {
  if (adjoint.data == nullptr) {
    columns::div(1.0, column, out, n);
  } else {
    columns::div(adjoint.data, column, out, n);
  }
  return {out, adjoint.scale};
}

void Differentiator::backward(std::size_t n) {
  // What lies below a sgn is never reached: its derivative is 0.
  for (const Leaf& leaf : leaves_) adjoints_[leaf.place] = {nullptr, 0};
  const std::size_t root = steps_.size() - 1;
  if (!steps_[root].wanted) return;
  adjoints_[root] = {nullptr, 1};
  for (std::size_t i = root + 1; i-- > 0;) {
    const Step& step = steps_[i];
    if (!step.wanted || arity(step.op) == 0) continue;
    const Adjoint& adjoint = adjoints_[i];
    switch (step.op) {
      case Op::add:
        adjoints_[step.a] = adjoint;
        adjoints_[step.b] = adjoint;
        break;
      case Op::sub:
        adjoints_[step.a] = adjoint;
        adjoints_[step.b] = {adjoint.data, -adjoint.scale};
        break;
      case Op::mul:
        backward_product(i, n);
        break;
      case Op::div:
        backward_quotient(i, n);
        break;
      case Op::pow:
        backward_power(i, n);
        break;
      default:
        backward_unary(i, n);
    }
  }
}

void Differentiator::backward_product(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  const Adjoint adjoint = adjoints_[place];
  const auto pass = [&](std::uint32_t child, std::uint32_t other) {
    if (!steps_[child].wanted) return;
    adjoints_[child] = is_scalar(other)
                           ? Adjoint{adjoint.data, adjoint.scale * scalars_[other]}
                           : times(adjoint, columns_[other], slot(steps_[child].adjoint_slot), n);
  };
  pass(step.a, step.b);
  pass(step.b, step.a);
}

// v = a / b:  dv/da = 1 / b,  dv/db = -v / b.
void Differentiator::backward_quotient(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  const Adjoint adjoint = adjoints_[place];
  const bool b_wanted = steps_[step.b].wanted;
  const auto pass_on_value = [&](const Adjoint& quotient) {
    Adjoint& b = adjoints_[step.b];
    if (is_scalar(place)) {
      b = {quotient.data, -quotient.scale * scalars_[place]};
    } else {
      b = times(quotient, columns_[place], slot(steps_[step.b].adjoint_slot), n);
      b.scale = -b.scale;
    }
  };
  if (is_scalar(step.b)) {
    const Adjoint quotient{adjoint.data, adjoint.scale / scalars_[step.b]};
    if (steps_[step.a].wanted) adjoints_[step.a] = quotient;
    if (b_wanted) pass_on_value(quotient);
    return;
  }
  const std::uint32_t first = steps_[step.a].wanted ? step.a : step.b;
  const Adjoint quotient = over(adjoint, columns_[step.b], slot(steps_[first].adjoint_slot), n);
  if (steps_[step.a].wanted) adjoints_[step.a] = quotient;
  if (b_wanted) pass_on_value(quotient);
}

void Differentiator::backward_power(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  if (steps_[step.a].wanted) backward_base(place, n);
  if (steps_[step.b].wanted) backward_exponent(place, n);
}

// dv/da = b a^(b-1).
void Differentiator::backward_base(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  const Adjoint adjoint = adjoints_[place];
  double* out = slot(steps_[step.a].adjoint_slot);
  Adjoint& base = adjoints_[step.a];
  if (is_scalar(place)) {
    double power = 0;
    const double exponent = scalars_[step.b];
    if (step.whole_power && step.exponent != 0) {
      columns::integer_power(&scalars_[step.a], step.exponent - 1, &power, 1);
    } else if (!step.whole_power) {
      power = elementary::pow(scalars_[step.a], exponent - 1);
    }
    base = {adjoint.data, adjoint.scale * exponent * power};
    return;
  }
  if (step.whole_power) {
    if (step.exponent == 0) {
      base = {nullptr, 0};
    } else if (step.exponent == 1) {
      base = adjoint;
    } else if (step.exponent == 2) {
      base = times(adjoint, columns_[step.a], out, n);
    } else {
      columns::integer_power(columns_[step.a], step.exponent - 1, out, n);
      base = times(adjoint, out, out, n);
    }
    base.scale *= step.exponent;
    return;
  }
  const double* exponent = column_of(step.b, spare(kWeighted), n);
  double* lowered = spare(kTemporary);
  columns::add(exponent, -1.0, lowered, n);
  columns::pow(column_of(step.a, spare(kOnes), n), lowered, out, n);
  columns::mul(out, exponent, out, n);
  base = times(adjoint, out, out, n);
}

// dv/db = v log a; 0 where v is 0 (the limit for a -> 0).
void Differentiator::backward_exponent(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  const Adjoint adjoint = adjoints_[place];
  if (is_scalar(place)) {
    const double v = scalars_[place];
    const double partial = v == 0 ? 0 : v * elementary::log(scalars_[step.a]);
    adjoints_[step.b] = {adjoint.data, adjoint.scale * partial};
    return;
  }
  double* out = slot(steps_[step.b].adjoint_slot);
  columns::log(column_of(step.a, spare(kTemporary), n), out, n);
  const double* v = columns_[place];
  for (std::size_t i = 0; i < n; ++i) out[i] = v[i] == 0 ? 0 : v[i] * out[i];
  adjoints_[step.b] = times(adjoint, out, out, n);
}

void Differentiator::backward_unary(std::size_t place, std::size_t n) {
  const Step& step = steps_[place];
  const Adjoint adjoint = adjoints_[place];
  Adjoint& child = adjoints_[step.a];
  if (is_scalar(place)) {
    const double partial = scalar_derivative(step.op, scalars_[step.a], scalars_[place]);
    child = {adjoint.data, adjoint.scale * partial};
    return;
  }
  const double* a = columns_[step.a];
  const double* v = columns_[place];
  double* out = slot(steps_[step.a].adjoint_slot);
  switch (step.op) {
    case Op::neg:
      child = {adjoint.data, -adjoint.scale};
      return;
    case Op::exp:
      child = times(adjoint, v, out, n);
      return;
    case Op::log:
      child = over(adjoint, a, out, n);
      return;
    case Op::sqrt:
      child = over(adjoint, v, out, n);
      child.scale *= 0.5;
      return;
    case Op::abs:
      columns::sgn(a, out, n);
      break;
    case Op::sin:
      columns::cos(a, out, n);
      break;
    case Op::cos:
      columns::sin(a, out, n);
      break;
    default:  // tanh; below a sgn nothing is wanted
      columns::one_minus_square(v, out, n);
  }
  child = times(adjoint, out, out, n);
  if (step.op == Op::cos) child.scale = -child.scale;
}

}  // namespace tribench
