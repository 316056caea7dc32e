// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

// How tightly a piece of text binds; a looser piece is put in parentheses.
enum Binding { kSum = 0, kProduct = 1, kMinus = 2, kPower = 3, kAtom = 4 };

struct Piece {
  std::string text;
  Binding binding = kAtom;
};

std::string at_least(const Piece& piece, Binding wanted) {
  return piece.binding >= wanted ? piece.text : fmt::format("({})", piece.text);
}

Piece print_binary(Op op, const Piece& a, const Piece& b) {
  switch (op) {
    case Op::add:
    case Op::sub:
      return {fmt::format("{} {} {}", a.text, op_name(op), at_least(b, kProduct)), kSum};
    case Op::mul:
    case Op::div:
      return {fmt::format("{}{}{}", at_least(a, kProduct), op_name(op), at_least(b, kMinus)),
              kProduct};
    default:
      // The base is an atom; the exponent a factor (2^-x and 2^x^y need no parentheses).
      return {fmt::format("{}^{}", at_least(a, kAtom), at_least(b, kMinus)), kPower};
  }
}

Piece print_constant(double value) {
  return {print_number(value), std::signbit(value) ? kMinus : kAtom};
}

Piece print_negation(const Node& child, const Piece& piece) {
  // -(2) would read back as the constant -2.
  if (child.is_constant()) return {fmt::format("-({})", piece.text), kMinus};
  return {fmt::format("-{}", at_least(piece, kMinus)), kMinus};
}

}  // namespace

std::string print_number(double value) { return fmt::format("{}", value); }

std::string print(const Expression& formula, std::span<const std::string> names) {
  std::vector<Piece> stack;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_constant()) {
      stack.push_back(print_constant(node.value));
    } else if (node.is_variable()) {
      if (node.variable >= names.size()) {
        throw Error(ErrorKind::failed, fmt::format("column {} has no name", node.variable));
      }
      stack.push_back({names[node.variable], kAtom});
    } else if (arity(node.op) == 2) {
      const Piece right = std::move(stack.back());
      stack.pop_back();
      stack.back() = print_binary(node.op, stack.back(), right);
    } else if (node.op == Op::neg) {
      stack.back() = print_negation(formula.node(i - 1), stack.back());
    } else {
      stack.back() = {fmt::format("{}({})", op_name(node.op), stack.back().text), kAtom};
    }
  }
  return stack.empty() ? std::string() : std::move(stack.back().text);
}

}  // namespace tribench
