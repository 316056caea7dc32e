// SPDX-License-Identifier: MIT
#include "algorithms/expression/natural_extension.hpp"

#include <algorithm>
#include <cmath>

namespace tribench {
namespace {

bool same_subtree(const Expression& formula, std::size_t a, std::size_t b) {
  if (formula.node(a).length != formula.node(b).length) return false;
  const auto nodes = formula.nodes();
  return std::equal(nodes.begin() + static_cast<std::ptrdiff_t>(formula.begin(a)),
                    nodes.begin() + static_cast<std::ptrdiff_t>(a + 1),
                    nodes.begin() + static_cast<std::ptrdiff_t>(formula.begin(b)));
}

}  // namespace

NaturalExtension::NaturalExtension(const Expression& formula)
    : formula_(formula), same_operands_(formula.size(), false) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (arity(formula.node(i).op) != 2) continue;
    same_operands_[i] = same_subtree(formula, formula.left_child(i), formula.last_child(i));
  }
}

DecoratedInterval NaturalExtension::extend(std::size_t i, std::span<const Interval> box,
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

std::size_t NaturalExtension::pass(std::span<const Interval> box, Values& values) const {
  for (std::size_t i = 0; i < formula_.size(); ++i) {
    values[i] = extend(i, box, values);
    if (!values[i].is_finite()) return i;
  }
  return formula_.size();
}

}  // namespace tribench
