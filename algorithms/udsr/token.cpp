// SPDX-License-Identifier: MIT
#include "algorithms/udsr/token.hpp"

#include <fmt/format.h>

namespace tribench::udsr {

TokenLibrary::TokenLibrary(const OperatorSet& operators, std::size_t inputs,
                           const TokenOptions& options) {
  const auto add = [this](Token token) {
    ++by_arity_[token.children];
    tokens_.push_back(std::move(token));
  };
  for (const Op op : operators.operators()) {
    // A general power has no place among the tokens: integer powers are products.
    if (op == Op::pow) continue;
    add({TokenKind::operation, op, 0, static_cast<std::uint8_t>(arity(op)),
         std::string(op_name(op))});
  }
  operations_ = tokens_.size();
  for (std::size_t i = 0; i < inputs; ++i) {
    add({TokenKind::input, Op::variable, static_cast<std::uint16_t>(i), 0,
         fmt::format("x{}", i + 1)});
  }
  if (options.constants) add({TokenKind::constant, Op::constant, 0, 0, "const"});
  if (options.linear) add({TokenKind::linear, Op::constant, 0, 0, "linear"});
}

std::vector<TokenId> TokenLibrary::with_children(int children) const {
  std::vector<TokenId> ids;
  for (std::size_t i = 0; i < tokens_.size(); ++i) {
    if (tokens_[i].children == children) ids.push_back(static_cast<TokenId>(i));
  }
  return ids;
}

std::size_t subtree_end(const TokenLibrary& library, std::span<const TokenId> sequence,
                        std::size_t start) {
  std::size_t open = 1;
  std::size_t at = start;
  while (open > 0) open = open + library[sequence[at++]].children - 1;
  return at;
}

}  // namespace tribench::udsr
