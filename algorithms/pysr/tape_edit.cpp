// SPDX-License-Identifier: MIT
#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

// Which child of `parent` stands at `place`: 0 or 1.
int child_number(const Expression& formula, std::size_t parent, std::size_t place) {
  return place == child_of(formula, parent, 0) ? 0 : 1;
}

}  // namespace

std::vector<Node> join(Op op, std::span<const Node> a) { return join(op, a, {}); }

std::vector<Node> join(Op op, std::span<const Node> a, std::span<const Node> b) {
  std::vector<Node> tape(a.begin(), a.end());
  tape.insert(tape.end(), b.begin(), b.end());
  tape.push_back({0, static_cast<std::uint32_t>(tape.size() + 1), 0, op});
  return tape;
}

Expression with_replaced(const Expression& formula, std::size_t i, std::span<const Node> postfix) {
  Expression result;
  splice(formula, i, postfix, result);
  return result;
}

Expression with_swapped_children(const Expression& formula, std::size_t i) {
  Expression result;
  swap_operands(formula, i, result);
  return result;
}

Expression with_rotation(const Expression& formula, std::size_t node, std::size_t pivot,
                         std::size_t grandchild) {
  Expression result;
  rotate(formula, node, child_number(formula, node, pivot),
         child_number(formula, pivot, grandchild), result);
  return result;
}

}  // namespace tribench::pysr
