// SPDX-License-Identifier: MIT
//
// Edits of a formula, as search makes them by the million. Each writes the edited formula into
// `out`, which keeps its memory: once it has grown to the largest formula, nothing is allocated.
// Cost: one pass over the tape. `out` must not be one of the formulas read.
//
// Positions are those of the tape: a subtree is named by its last node, [begin(i), i].
//
//   splice(f, i, g.nodes(), child);          // f with its subtree i replaced by g
//   swap_operands(f, i, child);              // ... a - b ...  ->  ... b - a ...
#pragma once

#include <cstddef>
#include <span>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// The nodes of the subtree that ends at i.
inline std::span<const Node> subtree_nodes(const Expression& formula, std::size_t i) {
  return formula.nodes().subspan(formula.begin(i), formula.node(i).length);
}

// Child c (0 or 1) of node i; a function has child 0 alone.
inline std::size_t child_of(const Expression& formula, std::size_t i, int c) {
  return c == arity(formula.node(i).op) - 1 ? formula.last_child(i) : formula.left_child(i);
}

// Places of the children of node i, left to right; 0, 1 or 2 of them.
struct Children {
  std::size_t place[2] = {0, 0};
  std::size_t count = 0;
};
Children children_of(const Expression& formula, std::size_t i);

// The parent of node i; `formula.size()` for the root. O(size).
std::size_t parent_of(const Expression& formula, std::size_t i);

// Whether node i is a constant and the exponent of a ^: part of the structure to most searches and
// fits. (A right child stands directly before its parent.)
inline bool is_exponent(const Expression& formula, std::size_t i) {
  return i + 1 < formula.size() && formula.node(i).is_constant() &&
         formula.node(i + 1).op == Op::pow;
}

// `base` with the subtree that ends at i replaced by `piece`, a whole formula in postfix order
// with its lengths set (the nodes of a formula or of a subtree).
void splice(const Expression& base, std::size_t i, std::span<const Node> piece, Expression& out);

// The operands of the binary node i change places.
void swap_operands(const Expression& base, std::size_t i, Expression& out);

// Rotation: child `pivot` of node i rises above it and hands it its own child `grandchild`; the
// order of the leaves stays where both are binary and pivot != grandchild, as in
//   (a + b) * c  ->  a + (b * c)        rotate(f, i, 0, 1)
// The pivot must not be a leaf. Number of nodes and multiset of operations stay.
// Source: Cranmer 2023 (PySR), mutation "rotate tree".
void rotate(const Expression& base, std::size_t i, int pivot, int grandchild, Expression& out);

}  // namespace tribench
