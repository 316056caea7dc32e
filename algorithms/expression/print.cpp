// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "algorithms/expression/infix.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"

namespace tribench {
namespace {

Piece print_binary(Op op, const Piece& a, const Piece& b, const Node& /*right*/) {
  if (op != Op::pow) return write_arithmetic(op, a, b);
  // The base is an atom; the exponent a factor (2^-x and 2^x^y need no parentheses).
  return {fmt::format("{}^{}", at_least(kAtom, a), at_least(kMinus, b)), kPower};
}

Piece print_unary(Op op, const Piece& a, const Node& child) {
  if (op != Op::neg) return {fmt::format("{}({})", op_name(op), a.text), kAtom};
  // -(2) would read back as the constant -2.
  if (child.is_constant()) return {fmt::format("-({})", a.text), kMinus};
  return {fmt::format("-{}", at_least(kMinus, a)), kMinus};
}

}  // namespace

std::string print_number(double value) { return fmt::format("{}", value); }

std::string print(const Expression& formula, std::span<const std::string> names) {
  const auto leaf = [&](const Node& node) -> Piece {
    if (node.is_constant()) {
      return {print_number(node.value), std::signbit(node.value) ? kMinus : kAtom};
    }
    if (node.variable >= names.size()) {
      throw Error(ErrorKind::failed, fmt::format("column {} has no name", node.variable));
    }
    require_formula_name(names[node.variable], "formula");
    return {names[node.variable], kAtom};
  };
  return write_pieces(formula, leaf, print_unary, print_binary);
}

}  // namespace tribench
