// SPDX-License-Identifier: MIT
#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

void append(std::vector<Node>& tape, std::span<const Node> nodes) {
  tape.insert(tape.end(), nodes.begin(), nodes.end());
}

Node operation(Op op, std::size_t length) { return {0, static_cast<std::uint32_t>(length), 0, op}; }

// op over the children of `node`, with `child` replaced by other nodes.
std::vector<Node> with_child(const Expression& formula, std::size_t node, std::size_t child,
                             std::span<const Node> replacement) {
  const Children children = children_of(formula, node);
  std::vector<Node> tape;
  for (std::size_t k = 0; k < children.count; ++k) {
    const std::size_t place = children.place[k];
    append(tape, place == child ? replacement : subtree_nodes(formula, place));
  }
  tape.push_back(operation(formula.node(node).op, tape.size() + 1));
  return tape;
}

}  // namespace

std::span<const Node> subtree_nodes(const Expression& formula, std::size_t i) {
  return formula.nodes().subspan(formula.begin(i), formula.node(i).length);
}

Children children_of(const Expression& formula, std::size_t i) {
  switch (arity(formula.node(i).op)) {
    case 0:
      return {};
    case 1:
      return {{formula.only_child(i), 0}, 1};
    default:
      return {{formula.left_child(i), formula.right_child(i)}, 2};
  }
}

std::size_t parent_of(const Expression& formula, std::size_t i) {
  for (std::size_t j = i + 1; j < formula.size(); ++j) {
    if (formula.begin(j) <= i) return j;
  }
  return formula.size();
}

std::vector<Node> join(Op op, std::span<const Node> a) {
  std::vector<Node> tape(a.begin(), a.end());
  tape.push_back(operation(op, tape.size() + 1));
  return tape;
}

std::vector<Node> join(Op op, std::span<const Node> a, std::span<const Node> b) {
  std::vector<Node> tape(a.begin(), a.end());
  append(tape, b);
  tape.push_back(operation(op, tape.size() + 1));
  return tape;
}

Expression with_replaced(const Expression& formula, std::size_t i, std::span<const Node> postfix) {
  Expression result = formula;
  result.replace(i, postfix);
  return result;
}

Expression with_swapped_children(const Expression& formula, std::size_t i) {
  const Children children = children_of(formula, i);
  return with_replaced(formula, i,
                       join(formula.node(i).op, subtree_nodes(formula, children.place[1]),
                            subtree_nodes(formula, children.place[0])));
}

Expression with_rotation(const Expression& formula, std::size_t node, std::size_t pivot,
                         std::size_t grandchild) {
  const std::vector<Node> lowered =
      with_child(formula, node, pivot, subtree_nodes(formula, grandchild));
  return with_replaced(formula, node, with_child(formula, pivot, grandchild, lowered));
}

bool is_exponent(const Expression& formula, std::size_t i) {
  if (i + 1 >= formula.size()) return false;
  // The right child of a binary node stands directly before it.
  return formula.node(i).is_constant() && formula.node(i + 1).op == Op::pow;
}

}  // namespace tribench::pysr
