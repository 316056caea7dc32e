// SPDX-License-Identifier: MIT
//
// The first step of translating a tape: every leaf becomes an operand. Part of program.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench {

// So many entries behind the last may be overwritten.
inline constexpr std::size_t kLeavesAtOnce = 8;

template <typename T>
struct LeafLists {
  const T* const* columns;    // never null; [0] may be, where no node is a variable
  T* scalars;                 // out: value of each node, in T
  const T** values;           // out: start of the column of each variable; of others &scalars[i]
  std::uint8_t* kinds;        // out: op of each node
  std::uint32_t* operations;  // out: the nodes that are no leaves, in order, and the tape's size
};

template <typename T>
using LeafReader = void (*)(std::span<const Node> tape, const LeafLists<T>& lists);

// The same lists on every level.
template <typename T>
LeafReader<T> leaf_reader(VectorLevel level);

}  // namespace tribench
