// SPDX-License-Identifier: MIT
//
// A formula written in one line, as print, SymPy and LaTeX have it: each operand is a piece of text
// that knows how tightly it binds and gets parentheses where its parent binds tighter. Not for code
// of one operation a statement (export_code.cpp).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

enum Binding { kSum = 0, kProduct = 1, kMinus = 2, kPower = 3, kAtom = 4 };

struct Piece {
  std::string text;
  Binding binding = kAtom;
};

// The text, between `open` and `close` where it binds less tightly than wanted.
std::string at_least(Binding wanted, const Piece& piece, std::string_view open = "(",
                     std::string_view close = ")");

// a + b, a - b, a*b or a/b.
Piece write_arithmetic(Op op, const Piece& a, const Piece& b);

// Walks the tape and has each node written: leaf(node), unary(op, piece, child) and
// binary(op, a, b, right), where child and right are the nodes that the last piece was made of.
// Empty for the empty formula.
template <typename Leaf, typename Unary, typename Binary>
std::string write_pieces(const Expression& formula, Leaf leaf, Unary unary, Binary binary) {
  std::vector<Piece> stack;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (arity(node.op) == 0) {
      stack.push_back(leaf(node));
    } else if (arity(node.op) == 1) {
      stack.back() = unary(node.op, stack.back(), formula.node(i - 1));
    } else {
      const Piece right = std::move(stack.back());
      stack.pop_back();
      stack.back() = binary(node.op, stack.back(), right, formula.node(i - 1));
    }
  }
  return stack.empty() ? std::string() : std::move(stack.back().text);
}

}  // namespace tribench
