// SPDX-License-Identifier: MIT
#include "algorithms/expression/bounds.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/operation_error.hpp"

namespace tribench {
namespace {

// Covers the rounding of the error bounds' own arithmetic, a few operations each.
constexpr double kInflate = 1 + 0x1p-40;

}  // namespace

FormulaBounds::FormulaBounds(const Expression& formula)
    : extension_(formula), values_(formula.size()), errors_(formula.size()) {
  for (const Node& node : formula.nodes()) {
    if (node.is_variable()) used_.push_back(node.variable);
  }
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
}

bool FormulaBounds::bound(std::span<const Interval> box) {
  failed_ = extension_.pass(box, values_);
  return failed_ == formula().size();
}

void FormulaBounds::choose_active(std::span<const Interval> box) {
  active_.clear();
  for (const std::size_t column : used_) {
    if (!box[column].is_point()) active_.push_back(column);
  }
  gradient_.begin(formula().size(), active_);
}

bool FormulaBounds::sharpen(std::span<const Interval> box) {
  choose_active(box);
  if (active_.empty()) {
    std::fill(errors_.begin(), errors_.end(), 0.0);
    const bool all = bound(box);
    real_root_ = values_.back().range;
    return all;
  }
  if (polynomials_.empty()) polynomials_ = polynomials_of(formula());
  points_.evaluate(extension_, box, active_);
  for (std::size_t i = 0; i < formula().size(); ++i) {
    values_[i] = extension_.extend(i, box, values_);
    if (!values_[i].is_finite()) {
      failed_ = i;
      return false;
    }
    bound_error(i);
    gradient_.bound(extension_, i, values_);
    real_root_ = values_[i].range;
    if (arity(formula().node(i).op) == 0) continue;
    refine(i, box);
    errors_[i] += rounding_of(i) * kInflate;
  }
  failed_ = formula().size();
  return true;
}

double FormulaBounds::rounding_of(std::size_t i) const {
  const Op op = formula().node(i).op;
  const std::size_t left = arity(op) == 2 ? formula().left_child(i) : i - 1;
  return rounding_error_of(op, values_[left].range, values_[i - 1].range,
                           extension_.has_same_operands(i), values_[i].range);
}

// The error that the operands bring, and how far the range of the real value is to be widened for
// it to hold the computed one. An operation that is rounded correctly needs no more than the
// former: rounding is monotone and the ends of a range are doubles.
void FormulaBounds::bound_error(std::size_t i) {
  const Op op = formula().node(i).op;
  const Interval& result = values_[i].range;
  const auto operand = [&](std::size_t node) {
    return Operand{values_[node].range, errors_[node]};
  };
  double moved = 0;
  if (arity(op) == 1) {
    moved = operand_error(op, operand(i - 1), result);
  } else if (arity(op) == 2) {
    const bool is_exact = extension_.has_same_operands(i) && (op == Op::sub || op == Op::div);
    const std::size_t left = formula().left_child(i);
    moved = is_exact ? 0 : operand_error(op, operand(left), operand(i - 1), result);
  }
  errors_[i] = std::isnan(moved) ? kInfinity : moved * kInflate;
  const bool is_rounded_correctly =
      op <= Op::div || op == Op::sqrt || op == Op::neg || op == Op::abs || op == Op::sgn;
  widening_ = errors_[i] + (is_rounded_correctly ? 0 : rounding_of(i) * kInflate);
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
  const Interval* derivatives = gradient_.of(i);
  Interval range = Interval::entire();
  if (points_.has_centre(i)) {
    range = points_.centre(i);
    for (std::size_t j = 0; j < active_.size(); ++j) {
      const Interval offset = subtract(box[active_[j]], points_.centre_of_input(active_[j]));
      range = add(range, multiply(derivatives[j], offset));
    }
  }
  if (!points_.narrow_between_corners(i, derivatives, range)) meet_polynomial(i, box, range);
  if (i == formula().root()) real_root_ = intersect(real_root_, range);
  if (!(widening_ < kInfinity)) return;
  range = {add_down(range.low, -widening_), add_up(range.high, widening_)};
  values_[i].range = intersect(values_[i].range, range);
}

Interval FormulaBounds::derivative(std::size_t node, std::size_t variable) const {
  for (std::size_t j = 0; j < active_.size(); ++j) {
    if (active_[j] == variable) return gradient_.of(node)[j];
  }
  return {0, 0};
}

Interval value_at(FormulaBounds& bounds, const std::vector<double>& point) {
  std::vector<Interval> box(point.size());
  for (std::size_t j = 0; j < point.size(); ++j) box[j] = Interval::point(point[j]);
  return bounds.bound(box) ? bounds.root().range : Interval::entire();
}

}  // namespace tribench
