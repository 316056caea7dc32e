// SPDX-License-Identifier: MIT
//
// Sequences by the names of their tokens.
#pragma once

#include <initializer_list>
#include <string_view>

#include "algorithms/udsr/token.hpp"

namespace tribench::udsr {

inline TokenId token_id(const TokenLibrary& library, std::string_view name) {
  TokenId id = 0;
  while (library[id].name != name) ++id;
  return id;
}

inline Sequence sequence_of(const TokenLibrary& library,
                            std::initializer_list<std::string_view> names) {
  Sequence sequence;
  for (const std::string_view name : names) sequence.push_back(token_id(library, name));
  return sequence;
}

}  // namespace tribench::udsr
