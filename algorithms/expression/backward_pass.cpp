// SPDX-License-Identifier: MIT
#include "algorithms/expression/backward_pass.hpp"

#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
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
    case Op::atan:
      return 1 / (1 + a * a);
    default:
      return 0;
  }
}

// adjoint * column; written to `out` only where both are columns. `out` may be `column`.
Adjoint times(const Adjoint& adjoint, const double* column, double* out, std::size_t n) {
  if (adjoint.data == nullptr) return {column, adjoint.scale};
  columns::mul(adjoint.data, column, out, n);
  return {out, adjoint.scale};
}

Adjoint over(const Adjoint& adjoint, const double* column, double* out, std::size_t n) {
  if (adjoint.data == nullptr) {
    columns::div(1.0, column, out, n);
  } else {
    columns::div(adjoint.data, column, out, n);
  }
  return {out, adjoint.scale};
}

}  // namespace

void BackwardPass::run() {
  // What lies below a sgn is never reached: its derivative is 0.
  for (const DerivativePlan::Leaf& leaf : plan_.leaves()) block_.adjoint(leaf.place) = {nullptr, 0};
  const std::size_t root = plan_.root();
  if (!plan_.steps()[root].wanted) return;
  block_.adjoint(root) = {nullptr, 1};
  for (std::size_t i = root + 1; i-- > 0;) {
    const DerivativePlan::Step& step = plan_.steps()[i];
    if (!step.wanted || arity(step.op) == 0) continue;
    const Adjoint& adjoint = block_.adjoint(i);
    switch (step.op) {
      case Op::add:
        block_.adjoint(step.a) = adjoint;
        block_.adjoint(step.b) = adjoint;
        break;
      case Op::sub:
        block_.adjoint(step.a) = adjoint;
        block_.adjoint(step.b) = {adjoint.data, -adjoint.scale};
        break;
      case Op::mul:
        product(i);
        break;
      case Op::div:
        quotient(i);
        break;
      case Op::pow:
        power(i);
        break;
      default:
        unary(i);
    }
  }
}

void BackwardPass::product(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  const Adjoint adjoint = block_.adjoint(place);
  const auto pass = [&](std::uint32_t child, std::uint32_t other) {
    if (!plan_.steps()[child].wanted) return;
    block_.adjoint(child) = plan_.is_scalar(other)
                                ? Adjoint{adjoint.data, adjoint.scale * plan_.scalar(other)}
                                : times(adjoint, block_.values(other),
                                        block_.slot(plan_.steps()[child].adjoint_slot), n_);
  };
  pass(step.a, step.b);
  pass(step.b, step.a);
}

// v = a / b:  dv/da = 1 / b,  dv/db = -v / b.
void BackwardPass::quotient(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  const Adjoint adjoint = block_.adjoint(place);
  const bool b_wanted = plan_.steps()[step.b].wanted;
  const auto pass_on_value = [&](const Adjoint& over_b) {
    Adjoint& b = block_.adjoint(step.b);
    if (plan_.is_scalar(place)) {
      b = {over_b.data, -over_b.scale * plan_.scalar(place)};
    } else {
      b = times(over_b, block_.values(place), block_.slot(plan_.steps()[step.b].adjoint_slot), n_);
      b.scale = -b.scale;
    }
  };
  if (plan_.is_scalar(step.b)) {
    const Adjoint over_b{adjoint.data, adjoint.scale / plan_.scalar(step.b)};
    if (plan_.steps()[step.a].wanted) block_.adjoint(step.a) = over_b;
    if (b_wanted) pass_on_value(over_b);
    return;
  }
  const std::uint32_t first = plan_.steps()[step.a].wanted ? step.a : step.b;
  const Adjoint over_b =
      over(adjoint, block_.values(step.b), block_.slot(plan_.steps()[first].adjoint_slot), n_);
  if (plan_.steps()[step.a].wanted) block_.adjoint(step.a) = over_b;
  if (b_wanted) pass_on_value(over_b);
}

void BackwardPass::power(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  if (plan_.steps()[step.a].wanted) base(place);
  if (plan_.steps()[step.b].wanted) exponent(place);
}

// dv/da = b a^(b-1).
void BackwardPass::base(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  const Adjoint adjoint = block_.adjoint(place);
  double* out = block_.slot(plan_.steps()[step.a].adjoint_slot);
  Adjoint& child = block_.adjoint(step.a);
  if (plan_.is_scalar(place)) {
    double power = 0;
    const double exponent = plan_.scalar(step.b);
    if (step.whole_power && step.exponent != 0) {
      columns::integer_power(&plan_.scalar(step.a), step.exponent - 1, &power, 1);
    } else if (!step.whole_power) {
      power = elementary::pow(plan_.scalar(step.a), exponent - 1);
    }
    child = {adjoint.data, adjoint.scale * exponent * power};
    return;
  }
  if (step.whole_power) {
    if (step.exponent == 0) {
      child = {nullptr, 0};
    } else if (step.exponent == 1) {
      child = adjoint;
    } else if (step.exponent == 2) {
      child = times(adjoint, block_.values(step.a), out, n_);
    } else {
      columns::integer_power(block_.values(step.a), step.exponent - 1, out, n_);
      child = times(adjoint, out, out, n_);
    }
    child.scale *= step.exponent;
    return;
  }
  const double* exponent =
      block_.column_of(plan_, step.b, block_.spare(DerivativeBlock::kWeighted), n_);
  double* lowered = block_.spare(DerivativeBlock::kTemporary);
  columns::add(exponent, -1.0, lowered, n_);
  columns::pow(block_.column_of(plan_, step.a, block_.spare(DerivativeBlock::kOnes), n_), lowered,
               out, n_);
  columns::mul(out, exponent, out, n_);
  child = times(adjoint, out, out, n_);
}

// dv/db = v log a; 0 where v is 0 (the limit for a -> 0).
void BackwardPass::exponent(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  const Adjoint adjoint = block_.adjoint(place);
  if (plan_.is_scalar(place)) {
    const double v = plan_.scalar(place);
    const double partial = v == 0 ? 0 : v * elementary::log(plan_.scalar(step.a));
    block_.adjoint(step.b) = {adjoint.data, adjoint.scale * partial};
    return;
  }
  double* out = block_.slot(plan_.steps()[step.b].adjoint_slot);
  columns::log(block_.column_of(plan_, step.a, block_.spare(DerivativeBlock::kTemporary), n_), out,
               n_);
  const double* v = block_.values(place);
  for (std::size_t i = 0; i < n_; ++i) out[i] = v[i] == 0 ? 0 : v[i] * out[i];
  block_.adjoint(step.b) = times(adjoint, out, out, n_);
}

void BackwardPass::unary(std::size_t place) {
  const DerivativePlan::Step& step = plan_.steps()[place];
  const Adjoint adjoint = block_.adjoint(place);
  Adjoint& child = block_.adjoint(step.a);
  if (plan_.is_scalar(place)) {
    const double partial = scalar_derivative(step.op, plan_.scalar(step.a), plan_.scalar(place));
    child = {adjoint.data, adjoint.scale * partial};
    return;
  }
  const double* a = block_.values(step.a);
  const double* v = block_.values(place);
  double* out = block_.slot(plan_.steps()[step.a].adjoint_slot);
  switch (step.op) {
    case Op::neg:
      child = {adjoint.data, -adjoint.scale};
      return;
    case Op::exp:
      child = times(adjoint, v, out, n_);
      return;
    case Op::log:
      child = over(adjoint, a, out, n_);
      return;
    case Op::sqrt:
      child = over(adjoint, v, out, n_);
      child.scale *= 0.5;
      return;
    case Op::abs:
      columns::sgn(a, out, n_);
      break;
    case Op::sin:
      columns::cos(a, out, n_);
      break;
    case Op::cos:
      columns::sin(a, out, n_);
      break;
    case Op::atan:
      columns::mul(a, a, out, n_);
      columns::add(out, 1.0, out, n_);
      child = over(adjoint, out, out, n_);
      return;
    default:  // tanh; below a sgn nothing is wanted
      columns::one_minus_square(v, out, n_);
  }
  child = times(adjoint, out, out, n_);
  if (step.op == Op::cos) child.scale = -child.scale;
}

}  // namespace tribench
