// SPDX-License-Identifier: MIT
#include "algorithms/expression/edit.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tribench {
namespace {

using Piece = std::span<const Node>;

// The tape of `base` with [begin(i), i] replaced by the pieces and then the nodes.
template <std::size_t Pieces, std::size_t Nodes>
void rewrite(const Expression& base, std::size_t i, const std::array<Piece, Pieces>& pieces,
             const std::array<Node, Nodes>& nodes, Expression& out) {
  const Piece tape = base.nodes();
  std::size_t size = Nodes;
  for (const Piece& piece : pieces) size += piece.size();
  const std::size_t begin = base.begin(i);
  const std::size_t removed = tape[i].length;
  const std::span<Node> result = out.reset(tape.size() - removed + size);
  Node* at =
      std::copy(tape.begin(), tape.begin() + static_cast<std::ptrdiff_t>(begin), result.data());
  for (const Piece& piece : pieces) at = std::copy(piece.begin(), piece.end(), at);
  at = std::copy(nodes.begin(), nodes.end(), at);
  for (std::size_t j = i + 1; j < tape.size(); ++j) {
    *at = tape[j];
    // Ancestors are the nodes behind i whose subtree reaches back over it.
    if (base.begin(j) <= i) at->length += static_cast<std::uint32_t>(size - removed);
    ++at;
  }
}

Node operation(Op op, std::size_t length) { return {0, static_cast<std::uint32_t>(length), 0, op}; }

}  // namespace

Children children_of(const Expression& formula, std::size_t i) {
  switch (arity(formula.node(i).op)) {
    case 0:
      return {};
    case 1:
      return {{formula.last_child(i), 0}, 1};
    default:
      return {{formula.left_child(i), formula.last_child(i)}, 2};
  }
}

std::size_t parent_of(const Expression& formula, std::size_t i) {
  for (std::size_t j = i + 1; j < formula.size(); ++j) {
    if (formula.begin(j) <= i) return j;
  }
  return formula.size();
}

void splice(const Expression& base, std::size_t i, std::span<const Node> piece, Expression& out) {
  rewrite<1, 0>(base, i, {piece}, {}, out);
}

void swap_operands(const Expression& base, std::size_t i, Expression& out) {
  rewrite<2, 1>(base, i,
                {subtree_nodes(base, base.last_child(i)), subtree_nodes(base, base.left_child(i))},
                {base.node(i)}, out);
}

void rotate(const Expression& base, std::size_t i, int pivot, int grandchild, Expression& out) {
  const std::size_t p = child_of(base, i, pivot);
  const Node root = base.node(i);
  const Node riser = base.node(p);
  const Piece handed = subtree_nodes(base, child_of(base, p, grandchild));
  // What each of the two keeps; empty for a function.
  Piece kept_by_root;
  if (arity(root.op) == 2) kept_by_root = subtree_nodes(base, child_of(base, i, 1 - pivot));
  Piece kept_by_riser;
  if (arity(riser.op) == 2) kept_by_riser = subtree_nodes(base, child_of(base, p, 1 - grandchild));
  const Node lowered = operation(root.op, kept_by_root.size() + handed.size() + 1);
  const Node raised = operation(riser.op, lowered.length + kept_by_riser.size() + 1);
  const Piece lowered_piece(&lowered, 1);
  const Piece first = pivot == 0 ? handed : kept_by_root;
  const Piece second = pivot == 0 ? kept_by_root : handed;
  if (grandchild == 0) {
    rewrite<4, 1>(base, i, {first, second, lowered_piece, kept_by_riser}, {raised}, out);
  } else {
    rewrite<4, 1>(base, i, {kept_by_riser, first, second, lowered_piece}, {raised}, out);
  }
}

}  // namespace tribench
