// SPDX-License-Identifier: MIT
//
// Edits of a formula that search needs: build, splice, swap and rotate subtrees of a tape. All
// return whole formulas; none checks constraints.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

// Nodes of the subtree that ends at i.
std::span<const Node> subtree_nodes(const Expression& formula, std::size_t i);

// Places of the children of node i, left to right; 0, 1 or 2 of them.
struct Children {
  std::size_t place[2] = {0, 0};
  std::size_t count = 0;
};
Children children_of(const Expression& formula, std::size_t i);

// The parent of node i; `formula.size()` for the root. O(size).
std::size_t parent_of(const Expression& formula, std::size_t i);

// op(a) or op(a, b) as a tape.
std::vector<Node> join(Op op, std::span<const Node> a);
std::vector<Node> join(Op op, std::span<const Node> a, std::span<const Node> b);

// `formula` with the subtree that ends at i replaced.
Expression with_replaced(const Expression& formula, std::size_t i, std::span<const Node> postfix);

// The two children of the binary node i change places.
Expression with_swapped_children(const Expression& formula, std::size_t i);

// Tree rotation: the child `pivot` of `node` rises into its place, `node` takes the place of
// `grandchild` (a child of pivot), and grandchild becomes node's child where pivot was.
Expression with_rotation(const Expression& formula, std::size_t node, std::size_t pivot,
                         std::size_t grandchild);

// Whether the constant at i is the exponent of a ^, which no fit may move and no mutation touches
// unless ^ is among the operators.
bool is_exponent(const Expression& formula, std::size_t i);

}  // namespace tribench::pysr
