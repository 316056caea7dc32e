// SPDX-License-Identifier: MIT
//
// The alphabet in which uDSR writes formulas, and formulas as pre-order token sequences.
//
// A sequence is what the policy samples and genetic programming edits; an Expression is what is
// evaluated. The linear token stands for a polynomial in the inputs whose coefficients are solved
// for (Landajuela et al. 2022, section 3.3).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"

namespace tribench::udsr {

using TokenId = std::uint8_t;
using Sequence = std::vector<TokenId>;

enum class TokenKind : std::uint8_t { operation, input, constant, linear };

struct Token {
  TokenKind kind = TokenKind::input;
  Op op = Op::variable;     // of an operation
  std::uint16_t input = 0;  // of an input
  std::uint8_t children = 0;
  std::string name;  // "+", "exp", "x1", "const", "linear": the key in weight files
};

struct TokenOptions {
  bool constants = false;
  bool linear = true;
};

class TokenLibrary {
 public:
  TokenLibrary(const OperatorSet& operators, std::size_t inputs, const TokenOptions& options);

  const Token& operator[](TokenId id) const { return tokens_[id]; }
  std::size_t size() const { return tokens_.size(); }
  std::size_t operations() const { return operations_; }  // they come first
  bool is_operation(TokenId id) const { return id < operations_; }
  std::size_t count_with_children(int children) const { return by_arity_[children]; }
  // Ids of the tokens with this number of children, in order.
  std::vector<TokenId> with_children(int children) const;

 private:
  std::vector<Token> tokens_;
  std::size_t operations_ = 0;
  std::size_t by_arity_[3] = {0, 0, 0};
};

// One past the end of the subtree that starts at `start` of a complete pre-order sequence.
std::size_t subtree_end(const TokenLibrary& library, std::span<const TokenId> sequence,
                        std::size_t start);

}  // namespace tribench::udsr
