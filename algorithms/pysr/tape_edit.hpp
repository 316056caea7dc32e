// SPDX-License-Identifier: MIT
//
// The edits of expression/edit.hpp as functions that return whole formulas, as this search keeps
// both parent and child. None checks constraints.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

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

}  // namespace tribench::pysr
