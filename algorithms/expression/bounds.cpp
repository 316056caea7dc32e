// SPDX-License-Identifier: MIT
#include "algorithms/expression/bounds.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr double kKernelError = kKernelUlps * std::numeric_limits<double>::epsilon();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
// A kernel of exp may flush results below the normal range to zero.
constexpr double kFlushed = std::numeric_limits<double>::min();
// Covers the rounding of the error bounds' own arithmetic, a few operations each.
constexpr double kInflate = 1 + 0x1p-40;

bool same_subtree(const Expression& formula, std::size_t a, std::size_t b) {
  if (formula.node(a).length != formula.node(b).length) return false;
  const auto nodes = formula.nodes();
  return std::equal(nodes.begin() + static_cast<std::ptrdiff_t>(formula.begin(a)),
                    nodes.begin() + static_cast<std::ptrdiff_t>(a + 1),
                    nodes.begin() + static_cast<std::ptrdiff_t>(formula.begin(b)));
}

// a * b for bounds of errors: 0 times anything is 0.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

}  // namespace

FormulaBounds::FormulaBounds(const Expression& formula)
    : formula_(formula),
      same_operands_(formula.size(), false),
      values_(formula.size()),
      errors_(formula.size()),
      centre_(formula.size()) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_variable()) used_.push_back(node.variable);
    if (arity(node.op) == 2) {
      same_operands_[i] = same_subtree(formula, formula.left_child(i), formula.right_child(i));
    }
  }
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
}

DecoratedInterval FormulaBounds::extend(std::size_t i, std::span<const Interval> box,
                                        const Values& values) const {
  const Node& node = formula_.node(i);
  if (node.is_variable()) return {box[node.variable]};
  if (node.is_constant()) {
    if (!std::isfinite(node.value)) return {Interval::entire(), Decoration::trivial};
    return {Interval::point(node.value)};
  }
  const DecoratedInterval& right = values[i - 1];
  if (arity(node.op) == 1) return apply(node.op, right);
  const DecoratedInterval& left = values[formula_.left_child(i)];
  if (same_operands_[i]) {
    if (node.op == Op::mul) return integer_power(left, 2);
    if (node.op == Op::sub) return {{0, 0}, left.decoration};
    if (node.op == Op::div && !left.range.contains(0)) return {{1, 1}, left.decoration};
  }
  return apply(node.op, left, right);
}

std::size_t FormulaBounds::pass(std::span<const Interval> box, Values& values) const {
  for (std::size_t i = 0; i < formula_.size(); ++i) {
    values[i] = extend(i, box, values);
    if (!values[i].is_finite()) return i;
  }
  return formula_.size();
}

bool FormulaBounds::bound(std::span<const Interval> box) {
  failed_ = pass(box, values_);
  return failed_ == formula_.size();
}

void FormulaBounds::choose_active(std::span<const Interval> box) {
  active_.clear();
  for (const std::size_t column : used_) {
    if (!box[column].is_point()) active_.push_back(column);
  }
  gradients_.resize(formula_.size() * active_.size());
}

void FormulaBounds::pass_points(std::span<const Interval> box) {
  point_box_.assign(box.begin(), box.end());
  for (const std::size_t column : active_) {
    point_box_[column] = Interval::point(midpoint(box[column]));
  }
  centre_failed_ = pass(point_box_, centre_);
  const std::size_t corners = active_.size() <= kMaxCornerInputs ? 1UL << active_.size() : 0;
  if (corners_.size() < corners) corners_.resize(corners, Values(formula_.size()));
  corners_failed_.assign(corners, 0);
  corner_box_ = point_box_;
  for (std::size_t c = 0; c < corners; ++c) {
    for (std::size_t j = 0; j < active_.size(); ++j) {
      const Interval& range = box[active_[j]];
      corner_box_[active_[j]] = Interval::point(((c >> j) & 1) != 0 ? range.high : range.low);
    }
    corners_failed_[c] = pass(corner_box_, corners_[c]);
  }
}

bool FormulaBounds::sharpen(std::span<const Interval> box) {
  choose_active(box);
  if (active_.empty()) {
    std::fill(errors_.begin(), errors_.end(), 0.0);
    const bool all = bound(box);
    real_root_ = values_.back().range;
    return all;
  }
  if (polynomials_.empty()) polynomials_ = polynomials_of(formula_);
  pass_points(box);
  for (std::size_t i = 0; i < formula_.size(); ++i) {
    values_[i] = extend(i, box, values_);
    if (!values_[i].is_finite()) {
      failed_ = i;
      return false;
    }
    bound_error(i);
    bound_gradient(i);
    real_root_ = values_[i].range;
    if (arity(formula_.node(i).op) == 0) continue;
    refine(i, box);
    errors_[i] += rounding_of(i) * kInflate;
  }
  failed_ = formula_.size();
  return true;
}

// |f(a) - f(a')| for the real operand a and the computed one a'.
double FormulaBounds::unary_error(std::size_t i) const {
  const Interval& a = values_[i - 1].range;
  const double ea = errors_[i - 1];
  switch (formula_.node(i).op) {
    case Op::exp:
      return times(values_[i].range.magnitude(), ea);
    case Op::log:
      return ea / a.low;
    case Op::sqrt: {
      const double root = std::sqrt(a.low);
      return root > 0 ? std::min(ea / root, std::sqrt(ea)) : std::sqrt(ea);
    }
    case Op::sgn:
      return ea == 0 || values_[i].range.is_point() ? 0 : 2;
    default:  // neg, abs, sin, cos, tanh: slopes of at most 1
      return ea;
  }
}

double FormulaBounds::binary_error(std::size_t i) const {
  const std::size_t left = formula_.left_child(i);
  const Interval& a = values_[left].range;
  const Interval& b = values_[i - 1].range;
  const double ea = errors_[left];
  const double eb = errors_[i - 1];
  const double magnitude = values_[i].range.magnitude();
  switch (formula_.node(i).op) {
    case Op::add:
    case Op::sub:
      return ea + eb;
    case Op::mul:
      return times(a.magnitude(), eb) + times(b.magnitude(), ea);
    case Op::div:
      return (ea + times(magnitude, eb)) / b.mignitude();
    default:
      break;
  }
  if (b.is_point() && is_integer_power(b.low) && b.low >= 1) {
    const int n = static_cast<int>(b.low);
    const double slope = n * integer_power({Interval::point(a.magnitude())}, n - 1).range.high;
    return times(slope, ea) + times(eb, kInfinity);
  }
  double moved = 0;
  if (ea > 0) moved += b.magnitude() * magnitude / a.mignitude() * ea;
  if (eb > 0) {
    const double logs =
        std::max(std::abs(elementary::log(a.low)), std::abs(elementary::log(a.high)));
    moved += (logs + 1e-9) * magnitude * eb;
  }
  return moved;
}

// What the operation itself errs by, given its result's range.
double FormulaBounds::rounding_of(std::size_t i) const {
  const double magnitude = values_[i].range.magnitude();
  switch (formula_.node(i).op) {
    case Op::neg:
    case Op::abs:
    case Op::sgn:
      return 0;
    case Op::add:
    case Op::sub:
      return same_operands_[i] ? 0 : kRoundoff * magnitude;  // x + x and x - x are exact
    case Op::mul:
      return scales_exactly(i) ? 0 : kRoundoff * magnitude + kTiny;
    case Op::div:
    case Op::sqrt:
      return kRoundoff * magnitude + kTiny;
    case Op::exp:
      return kKernelError * magnitude + kFlushed;
    case Op::log:
      return kKernelError * magnitude + kTiny;
    case Op::pow: {
      const double exponent = std::min(values_[i - 1].range.magnitude(), 1100.0);
      return (kKernelError + 2 * exponent * kRoundoff) * magnitude + kTiny;
    }
    default:  // sin, cos, tanh; the second term is the reduced argument's
      return kKernelError * magnitude + 0x1p-58 * (1 + values_[i - 1].range.magnitude());
  }
}

// Whether one factor is +-2^k, k >= 0, everywhere.
bool FormulaBounds::scales_exactly(std::size_t i) const {
  for (const std::size_t factor : {formula_.left_child(i), i - 1}) {
    const Interval& x = values_[factor].range;
    int exponent = 0;
    const double mantissa = std::frexp(x.low, &exponent);
    if (x.is_point() && std::abs(mantissa) == 0.5 && exponent >= 1) return true;
  }
  return false;
}

// The error that the operands bring, and how far the range of the real value is to be widened for
// it to hold the computed one. An operation that is rounded correctly needs no more than the
// former: rounding is monotone and the ends of a range are doubles.
void FormulaBounds::bound_error(std::size_t i) {
  const Op op = formula_.node(i).op;
  double moved = 0;
  if (arity(op) == 1) {
    moved = unary_error(i);
  } else if (arity(op) == 2) {
    const bool is_exact = same_operands_[i] && (op == Op::sub || op == Op::div);
    moved = is_exact ? 0 : binary_error(i);
  }
  errors_[i] = std::isnan(moved) ? kInfinity : moved * kInflate;
  const bool is_rounded_correctly =
      op <= Op::div || op == Op::sqrt || op == Op::neg || op == Op::abs || op == Op::sgn;
  widening_ = errors_[i] + (is_rounded_correctly ? 0 : rounding_of(i) * kInflate);
}

Interval FormulaBounds::unary_slope(std::size_t i) const {
  const DecoratedInterval& a = values_[i - 1];
  const Interval& y = values_[i].range;
  switch (formula_.node(i).op) {
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
    default:
      return intersect(subtract({1, 1}, integer_power({y}, 2).range), {0, 1});
  }
}

void FormulaBounds::power_gradient(std::size_t i) {
  const std::size_t left = formula_.left_child(i);
  const DecoratedInterval& x = values_[left];
  const DecoratedInterval& y = values_[i - 1];
  const Interval* gx = gradient(left);
  const Interval* gy = gradient(i - 1);
  Interval by_base = Interval::entire();
  Interval by_exponent = Interval::entire();
  const DecoratedInterval lower = apply(Op::pow, x, apply(Op::sub, y, DecoratedInterval{{1, 1}}));
  if (lower.decoration > Decoration::trivial) by_base = multiply(y.range, lower.range);
  if (x.range.low > 0) by_exponent = multiply(values_[i].range, apply(Op::log, x).range);
  for (std::size_t j = 0; j < active_.size(); ++j) {
    gradient(i)[j] = add(multiply(by_base, gx[j]), multiply(by_exponent, gy[j]));
  }
}

void FormulaBounds::bound_gradient(std::size_t i) {
  const Node& node = formula_.node(i);
  const std::size_t k = active_.size();
  Interval* g = gradient(i);
  if (arity(node.op) == 0) {
    for (std::size_t j = 0; j < k; ++j) {
      const double slope = node.is_variable() && node.variable == active_[j] ? 1 : 0;
      g[j] = Interval::point(slope);
    }
    return;
  }
  if (arity(node.op) == 1) {
    const Interval slope = unary_slope(i);
    for (std::size_t j = 0; j < k; ++j) g[j] = multiply(slope, gradient(i - 1)[j]);
    return;
  }
  if (node.op == Op::pow) return power_gradient(i);
  const std::size_t left = formula_.left_child(i);
  const Interval& a = values_[left].range;
  const Interval& b = values_[i - 1].range;
  const Interval* ga = gradient(left);
  const Interval* gb = gradient(i - 1);
  const bool is_flat = same_operands_[i] && (node.op == Op::sub || node.op == Op::div);
  for (std::size_t j = 0; j < k; ++j) {
    if (is_flat) {
      g[j] = {0, 0};
    } else if (node.op == Op::add) {
      g[j] = add(ga[j], gb[j]);
    } else if (node.op == Op::sub) {
      g[j] = subtract(ga[j], gb[j]);
    } else if (node.op == Op::mul) {
      g[j] = add(multiply(ga[j], b), multiply(a, gb[j]));
    } else {
      g[j] = divide(subtract(ga[j], multiply(values_[i].range, gb[j])), b);
    }
  }
}

bool FormulaBounds::meet_corners(std::size_t i, Interval& range) const {
  if (active_.size() > kMaxCornerInputs) return false;
  const Interval* g = gradient(i);
  std::size_t low_corner = 0;
  for (std::size_t j = 0; j < active_.size(); ++j) {
    if (g[j].low < 0 && g[j].high > 0) return false;
    if (g[j].high <= 0) low_corner |= 1UL << j;
  }
  const std::size_t high_corner = ((1UL << active_.size()) - 1) ^ low_corner;
  if (corners_failed_[low_corner] <= i || corners_failed_[high_corner] <= i) return false;
  range =
      intersect(range, {corners_[low_corner][i].range.low, corners_[high_corner][i].range.high});
  return true;
}

void FormulaBounds::meet_polynomial(std::size_t i, std::span<const Interval> box,
                                    Interval& range) const {
  if (!polynomials_[i]) return;
  const Interval& x = box[polynomials_[i]->variable];
  if (!x.is_point()) {
    range = intersect(range, polynomial_range(polynomials_[i]->coefficients, x));
  }
}

void FormulaBounds::refine(std::size_t i, std::span<const Interval> box) {
  Interval range = Interval::entire();
  if (centre_failed_ > i) {
    range = centre_[i].range;
    for (std::size_t j = 0; j < active_.size(); ++j) {
      const Interval& side = box[active_[j]];
      const Interval offset = subtract(side, point_box_[active_[j]]);
      range = add(range, multiply(gradient(i)[j], offset));
    }
  }
  if (!meet_corners(i, range)) meet_polynomial(i, box, range);
  if (i == formula_.root()) real_root_ = intersect(real_root_, range);
  if (!(widening_ < kInfinity)) return;
  range = {add_down(range.low, -widening_), add_up(range.high, widening_)};
  values_[i].range = intersect(values_[i].range, range);
}

Interval FormulaBounds::derivative(std::size_t node, std::size_t variable) const {
  for (std::size_t j = 0; j < active_.size(); ++j) {
    if (active_[j] == variable) return gradient(node)[j];
  }
  return {0, 0};
}

}  // namespace tribench
