// SPDX-License-Identifier: MIT
#include "algorithms/expression/infix.hpp"

#include <fmt/format.h>

namespace tribench {

std::string at_least(Binding wanted, const Piece& piece, std::string_view open,
                     std::string_view close) {
  return piece.binding >= wanted ? piece.text : fmt::format("{}{}{}", open, piece.text, close);
}

Piece write_arithmetic(Op op, const Piece& a, const Piece& b) {
  if (op == Op::add || op == Op::sub) {
    return {fmt::format("{} {} {}", a.text, op_name(op), at_least(kProduct, b)), kSum};
  }
  return {fmt::format("{}{}{}", at_least(kProduct, a), op_name(op), at_least(kMinus, b)), kProduct};
}

}  // namespace tribench
