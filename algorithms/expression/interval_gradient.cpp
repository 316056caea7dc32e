// SPDX-License-Identifier: MIT
#include "algorithms/expression/interval_gradient.hpp"

namespace tribench {
namespace {

Interval unary_slope(Op op, const DecoratedInterval& a, const Interval& y) {
  switch (op) {
    case Op::neg:
      return {-1, -1};
    case Op::exp:
      return y;
    case Op::log:
      return divide({1, 1}, a.range);
    case Op::sqrt:
      if (y.low > 0) return divide({0.5, 0.5}, y);
      return {y.high > 0 ? div_down(0.5, y.high) : 0, kInfinity};
    case Op::abs:
      return {a.range.low >= 0 ? 1.0 : -1.0, a.range.high <= 0 ? -1.0 : 1.0};
    case Op::sgn:
      return y.is_point() ? Interval{0, 0} : Interval::entire();
    case Op::sin:
      return apply(Op::cos, a).range;
    case Op::cos:
      return negate(apply(Op::sin, a).range);
    case Op::atan:
      return divide({1, 1}, add({1, 1}, integer_power({a.range}, 2).range));
    default:
      return intersect(subtract({1, 1}, integer_power({y}, 2).range), {0, 1});
  }
}

}  // namespace

void IntervalGradient::begin(std::size_t nodes, const std::vector<std::size_t>& inputs) {
  inputs_ = inputs;
  ranges_.resize(nodes * inputs_.size());
}

void IntervalGradient::bound(const NaturalExtension& extension, std::size_t i,
                             const NaturalExtension::Values& values) {
  const Op op = extension.formula().node(i).op;
  if (arity(op) == 0) return bound_leaf(extension.formula().node(i), i);
  if (op == Op::pow) return bound_power(extension, i, values);
  if (arity(op) == 2) return bound_arithmetic(extension, i, values);
  const Interval slope = unary_slope(op, values[i - 1], values[i].range);
  for (std::size_t j = 0; j < inputs_.size(); ++j) at(i)[j] = multiply(slope, at(i - 1)[j]);
}

void IntervalGradient::bound_leaf(const Node& node, std::size_t i) {
  for (std::size_t j = 0; j < inputs_.size(); ++j) {
    const double slope = node.is_variable() && node.variable == inputs_[j] ? 1 : 0;
    at(i)[j] = Interval::point(slope);
  }
}

void IntervalGradient::bound_power(const NaturalExtension& extension, std::size_t i,
                                   const NaturalExtension::Values& values) {
  const std::size_t left = extension.formula().left_child(i);
  const DecoratedInterval& x = values[left];
  const DecoratedInterval& y = values[i - 1];
  const Interval* gx = at(left);
  const Interval* gy = at(i - 1);
  Interval by_base = Interval::entire();
  Interval by_exponent = Interval::entire();
  const DecoratedInterval lower = apply(Op::pow, x, apply(Op::sub, y, DecoratedInterval{{1, 1}}));
  if (lower.decoration > Decoration::trivial) by_base = multiply(y.range, lower.range);
  if (x.range.low > 0) by_exponent = multiply(values[i].range, apply(Op::log, x).range);
  for (std::size_t j = 0; j < inputs_.size(); ++j) {
    at(i)[j] = add(multiply(by_base, gx[j]), multiply(by_exponent, gy[j]));
  }
}

void IntervalGradient::bound_arithmetic(const NaturalExtension& extension, std::size_t i,
                                        const NaturalExtension::Values& values) {
  const Op op = extension.formula().node(i).op;
  const std::size_t left = extension.formula().left_child(i);
  const Interval& a = values[left].range;
  const Interval& b = values[i - 1].range;
  const Interval* ga = at(left);
  const Interval* gb = at(i - 1);
  Interval* g = at(i);
  const bool is_flat = extension.has_same_operands(i) && (op == Op::sub || op == Op::div);
  for (std::size_t j = 0; j < inputs_.size(); ++j) {
    if (is_flat) {
      g[j] = {0, 0};
    } else if (op == Op::add) {
      g[j] = add(ga[j], gb[j]);
    } else if (op == Op::sub) {
      g[j] = subtract(ga[j], gb[j]);
    } else if (op == Op::mul) {
      g[j] = add(multiply(ga[j], b), multiply(a, gb[j]));
    } else {
      g[j] = divide(subtract(ga[j], multiply(values[i].range, gb[j])), b);
    }
  }
}

}  // namespace tribench
