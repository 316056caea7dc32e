// SPDX-License-Identifier: MIT
#include "algorithms/expression/witness.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/apply.hpp"

namespace tribench {
namespace {

constexpr int kBisectAttempts = 4;

// Adds `node` and the nodes whose zeros are zeros (or poles) of it: the factors of a product, the
// base of a constant power, the numerator of a quotient.
void collect_zero_nodes(const Expression& formula, std::size_t node,
                        std::vector<std::size_t>& nodes) {
  nodes.push_back(node);
  switch (formula.node(node).op) {
    case Op::mul:
      collect_zero_nodes(formula, formula.left_child(node), nodes);
      collect_zero_nodes(formula, formula.last_child(node), nodes);
      return;
    case Op::pow: {
      const Node& exponent = formula.node(formula.last_child(node));
      if (!exponent.is_constant() || exponent.value == 0) return;
      collect_zero_nodes(formula, formula.left_child(node), nodes);
      return;
    }
    case Op::div:
      collect_zero_nodes(formula, formula.left_child(node), nodes);
      return;
    case Op::neg:
    case Op::abs:
    case Op::sqrt:
    case Op::sgn:
    case Op::sin:
    case Op::tanh:
    case Op::atan:
      collect_zero_nodes(formula, formula.last_child(node), nodes);
      return;
    default:
      return;
  }
}

bool has_pole_exponent(const Expression& formula, std::size_t power) {
  const Node& exponent = formula.node(formula.last_child(power));
  return exponent.is_constant() && exponent.value < 0;
}

}  // namespace

WitnessSearch::WitnessSearch(const Expression& formula)
    : formula_(formula), bounds_(formula), random_(key_of("witness")), values_(formula.size()) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_variable()) columns_.push_back(node.variable);
    if (node.op == Op::div || node.op == Op::log) {
      collect_zero_nodes(formula, formula.last_child(i), zeros_);
    }
    if (node.op == Op::pow && has_pole_exponent(formula, i)) {
      collect_zero_nodes(formula, formula.left_child(i), zeros_);
    }
  }
  std::sort(columns_.begin(), columns_.end());
  columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  std::sort(zeros_.begin(), zeros_.end());
  zeros_.erase(std::unique(zeros_.begin(), zeros_.end()), zeros_.end());
  std::erase_if(zeros_, [&](std::size_t i) { return formula.node(i).is_constant(); });
}

void WitnessSearch::enter(std::span<const Interval> cell) {
  cell_.assign(cell.begin(), cell.end());
  signs_.assign(zeros_.size(), {});
}

std::size_t culprit_of(const Expression& formula, std::size_t failed) {
  const Op op = formula.node(failed).op;
  if (op == Op::div || op == Op::log || op == Op::sqrt) return failed - 1;
  if (op == Op::pow) return formula.left_child(failed);
  return failed;
}

std::size_t WitnessSearch::trace(std::span<const double> point) {
  std::size_t failed = formula_.size();
  for (std::size_t i = 0; i < formula_.size(); ++i) {
    const Node& node = formula_.node(i);
    if (node.is_constant()) {
      values_[i] = node.value;
    } else if (node.is_variable()) {
      values_[i] = point[node.variable];
    } else if (arity(node.op) == 1) {
      values_[i] = apply(node.op, values_[i - 1]);
    } else {
      values_[i] = apply(node.op, values_[formula_.left_child(i)], values_[i - 1]);
    }
    if (failed == formula_.size() && !std::isfinite(values_[i])) failed = i;
  }
  return failed;
}

double WitnessSearch::computed(std::size_t node, std::span<const double> point) {
  return evaluator_.evaluate_at(subtree(formula_, node), point);
}

// The trace is the C library's; what counts is the evaluator's.
std::optional<Witness> WitnessSearch::confirm(std::span<const double> point) {
  for (std::size_t i = 0; i < formula_.size(); ++i) {
    if (!std::isfinite(computed(i, point))) {
      return Witness{{point.begin(), point.end()}, {}, i};
    }
  }
  return std::nullopt;
}

std::optional<Witness> WitnessSearch::probe(std::span<const double> point) {
  const std::size_t failed = trace(point);
  if (failed < formula_.size()) return confirm(point);
  return compare_signs(point);
}

std::optional<Witness> WitnessSearch::compare_signs(std::span<const double> point) {
  for (std::size_t z = 0; z < zeros_.size(); ++z) {
    const double value = values_[zeros_[z]];
    Signs& signs = signs_[z];
    if (signs.attempts >= kBisectAttempts) continue;
    std::vector<double>& same = value < 0 ? signs.negative : signs.positive;
    const std::vector<double>& other = value < 0 ? signs.positive : signs.negative;
    if (same.empty()) {
      same.assign(point.begin(), point.end());
      if (other.empty()) continue;
    } else if (signs.attempts == 0 || other.empty()) {
      continue;
    }
    ++signs.attempts;
    const std::vector<double> from(point.begin(), point.end());
    const std::vector<double> to = other;
    if (auto witness = bisect(zeros_[z], from, to)) return witness;
  }
  return std::nullopt;
}

// Walks from a to b one input at a time and bisects the side on which the sign changes.
std::optional<Witness> WitnessSearch::bisect(std::size_t node, std::vector<double> a,
                                             std::vector<double> b) {
  const bool is_negative = computed(node, a) < 0;
  for (const std::size_t axis : columns_) {
    if (a[axis] == b[axis]) continue;
    std::vector<double> corner = a;
    corner[axis] = b[axis];
    const std::size_t failed = trace(corner);
    if (failed < formula_.size()) return confirm(corner);
    if ((computed(node, corner) < 0) != is_negative) return bisect_axis(node, a, b[axis], axis);
    a = std::move(corner);
  }
  return std::nullopt;
}

std::optional<Witness> WitnessSearch::bisect_axis(std::size_t node, std::vector<double> a, double b,
                                                  std::size_t axis) {
  const bool is_negative = computed(node, a) < 0;
  std::vector<double> other = a;
  other[axis] = b;
  while (true) {
    const Interval side{std::min(a[axis], other[axis]), std::max(a[axis], other[axis])};
    const double middle = midpoint(side);
    if (middle == side.low || middle == side.high) break;
    std::vector<double> at = a;
    at[axis] = middle;
    const double value = computed(node, at);
    if (value == 0 || !std::isfinite(value)) return confirm(at);
    ((value < 0) == is_negative ? a : other)[axis] = middle;
  }
  const double at_a = computed(node, a);
  const double at_b = computed(node, other);
  if (at_a == 0) return confirm(a);
  if (at_b == 0) return confirm(other);
  if ((at_a < 0) == (at_b < 0)) return std::nullopt;
  if (!is_continuous_between(node, a, other)) return std::nullopt;
  if (a[axis] > other[axis]) std::swap(a, other);
  return Witness{std::move(a), std::move(other), node};
}

bool WitnessSearch::is_continuous_between(std::size_t node, const std::vector<double>& a,
                                          const std::vector<double>& b) {
  std::vector<Interval> box(a.size());
  for (std::size_t j = 0; j < a.size(); ++j) {
    box[j] = {std::min(a[j], b[j]), std::max(a[j], b[j])};
  }
  const bool all = bounds_.bound(box);
  return (all || bounds_.failed_node() > node) &&
         bounds_.at(node).decoration >= Decoration::continuous;
}

std::optional<Witness> WitnessSearch::probe_corners(std::span<const Interval> box) {
  std::vector<std::size_t> active;
  point_.resize(box.size());
  for (std::size_t j = 0; j < box.size(); ++j) point_[j] = midpoint(box[j]);
  for (const std::size_t column : columns_) {
    if (!box[column].is_point()) active.push_back(column);
  }
  if (auto witness = probe(point_)) return witness;
  if (active.size() > kMaxCornerInputs) active.resize(kMaxCornerInputs);
  for (std::size_t corner = 0; corner < (1UL << active.size()); ++corner) {
    for (std::size_t j = 0; j < active.size(); ++j) {
      const Interval& side = box[active[j]];
      point_[active[j]] = ((corner >> j) & 1) != 0 ? side.high : side.low;
    }
    if (auto witness = probe(point_)) return witness;
  }
  return std::nullopt;
}

std::optional<Witness> WitnessSearch::probe_random(std::span<const Interval> box, int count) {
  point_.resize(box.size());
  for (int i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      const double at = box[j].low + random_.uniform() * (box[j].high - box[j].low);
      point_[j] = std::clamp(at, box[j].low, box[j].high);
    }
    if (auto witness = probe(point_)) return witness;
  }
  return std::nullopt;
}

double WitnessSearch::distance(std::size_t failed) const {
  const double value = values_[culprit_of(formula_, failed)];
  switch (formula_.node(failed).op) {
    case Op::log:
    case Op::sqrt:
      return value;
    case Op::div:
    case Op::pow:
      return std::abs(value);
    default:
      return -std::abs(value);
  }
}

double WitnessSearch::distance_at(std::span<const double> point, std::size_t failed) {
  trace(point);
  return distance(failed);
}

// Golden-section search along one input.
void WitnessSearch::descend_axis(Interval side, std::size_t axis, std::size_t failed,
                                 std::vector<double>& at) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 70;
  for (int step = 0; step < kSteps; ++step) {
    const double width = side.high - side.low;
    const double left = side.high - kGolden * width;
    const double right = side.low + kGolden * width;
    if (!(side.low < left && left < right && right < side.high)) break;
    at[axis] = left;
    const double at_left = distance_at(at, failed);
    at[axis] = right;
    if (at_left < distance_at(at, failed)) {
      side.high = right;
    } else {
      side.low = left;
    }
  }
  at[axis] = midpoint(side);
}

std::optional<Witness> WitnessSearch::descend(std::span<const Interval> box, std::size_t failed) {
  constexpr int kSweeps = 2;
  constexpr int kNeighbours = 16;
  std::vector<double> at(box.size());
  for (std::size_t j = 0; j < box.size(); ++j) at[j] = midpoint(box[j]);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const std::size_t axis : columns_) {
      if (!box[axis].is_point()) descend_axis(box[axis], axis, failed, at);
    }
  }
  for (const std::size_t axis : columns_) {
    std::vector<double> beside = at;
    for (int i = 0; i < kNeighbours; ++i) beside[axis] = next_down(beside[axis]);
    for (int i = -kNeighbours; i <= kNeighbours; ++i) {
      if (box[axis].contains(beside[axis])) {
        if (auto witness = probe(beside)) return witness;
      }
      beside[axis] = next_up(beside[axis]);
    }
  }
  return std::nullopt;
}

}  // namespace tribench
