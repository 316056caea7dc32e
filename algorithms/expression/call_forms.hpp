// SPDX-License-Identifier: MIT
//
// The tables that the translation of a tape looks up instead of deciding: what becomes of an
// operation whose operands are known, and which kernel runs it on operands from where. Part of
// program.hpp.
//
// Why tables: random formulas are unpredictable to the processor's branch prediction, and a wrong
// guess costs as much as fifty instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/kernels.hpp"

namespace tribench {

// What a node is to its parent. The first two are the Ops of leaves.
enum ValueKind : std::uint8_t {
  kScalarValue,  // also of an operation on constants
  kColumnValue,
  kBufferValue,
  // An operation held back until its parent is seen: kHeldValue + 3 op + form, x * x after them.
  kHeldValue,
  kHeldSquare = kHeldValue + kBasicOps * kFormCount,
};
static_assert(kScalarValue == static_cast<int>(Op::constant));
static_assert(kColumnValue == static_cast<int>(Op::variable));
static_assert(kHeldSquare == 15, "four bits hold a kind");

// Numbers of the calls: an operation held back alone, functions, powers, then pairs.
inline constexpr int kFunctionCall = kHeldSquare - kHeldValue + 1;
inline constexpr int kPowerCall = kFunctionCall + kFunctions;
inline constexpr int kIntegerPowerCall = kPowerCall + kFormCount;
inline constexpr int kPairCall = kIntegerPowerCall + 1;
constexpr int pair_call(int held, int op, bool held_is_right, bool other_is_scalar) {
  return kPairCall + ((held - kHeldValue) * kBasicOps + op) * 4 + (held_is_right ? 2 : 0) +
         (other_is_scalar ? 1 : 0);
}
inline constexpr int kCallCount = pair_call(kHeldSquare, kBasicOps - 1, true, true) + 1;

// Of an operation whose operands are known.
struct Decision {
  std::uint16_t call = 0;          // its number, where there is one
  std::uint8_t kind = 0;           // what the node is to its parent
  std::uint8_t settles_right = 0;  // 1: the right child, held back, has to be computed first
  std::uint8_t calls = 0;          // 1: the node is computed itself
  std::uint8_t is_special = 0;     // 1: needs more than the table
};

// Of an operation and the kinds of its children (left: any for a function).
inline constexpr std::size_t kDecisions = std::size_t{kOpCount} * 256;
constexpr std::size_t decision_index(Op op, unsigned left, unsigned right) {
  return static_cast<std::size_t>(op) << 8 | left << 4 | right;
}
extern const std::array<Decision, kDecisions> kDecisionTable;

// A kernel and where its operands come from. `right` and `left` are the children of the node; the
// inner node is the node itself or that child of it which was held back, a and b are children of
// the inner node, c is the other child. Masks are 0 or -1; a child is found by stepping back over
// the right child, and over the length of that where the mask says so.
template <typename T>
struct CallForm {
  BlockKernel<T> kernel = nullptr;
  std::int8_t inner_is_child = 0;  // 1: a child, 0: the node
  std::int8_t inner_is_left = 0;   // mask
  std::int8_t other_is_left = 0;   // mask
  std::int8_t a_is_left = 0;       // mask
  std::int8_t b_is_left = 0;       // mask
};

template <typename T>
using CallForms = std::array<CallForm<T>, kCallCount>;
template <typename T>
const CallForms<T>& call_forms(VectorLevel level);

}  // namespace tribench
