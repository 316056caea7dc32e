// SPDX-License-Identifier: MIT
//
// The block kernels: one pass over up to a few hundred rows for one or two operations of a tape.
// A table of function pointers a vector level and a scalar type; the interpreter picks from it.
// Included by translation units that are compiled for other instruction sets: it must stay free
// of inline functions with external linkage (the linker may keep any one copy of those).
//
// Every kernel reads and writes exactly n elements, in any alignment; out may be a, b or c.
// An operand that is a scalar is read through its pointer once. Square roots, quotients and all
// other basic operations are IEEE; the accuracy of the others is stated in elementary.hpp.
#pragma once

#include <cstddef>

namespace tribench {

enum class VectorLevel;

template <typename T>
using BlockKernel = void (*)(T* out, const T* a, const T* b, const T* c, std::size_t n);

// Which operands of a binary operation are vectors (v) and which scalars (s).
enum OperandForm : int { kFormVV, kFormVS, kFormSV, kFormCount };

// + - * / with the operand from elsewhere on the right, then those where its side matters, on the
// left.
enum OuterForm : int {
  kOuterAdd,
  kOuterSub,
  kOuterMul,
  kOuterDiv,
  kOuterSubFrom,  // c - (a o b)
  kOuterDivInto,  // c / (a o b)
  kOuterCount
};

inline constexpr int kBasicOps = 4;    // + - * /
inline constexpr int kFunctions = 10;  // neg .. atan, in the order of Op

template <typename T>
struct KernelTable {
  BlockKernel<T> binary[kBasicOps][kFormCount];
  // (a o b) O c and c O (a o b); the last index tells whether c is a scalar.
  BlockKernel<T> pair[kBasicOps][kFormCount][kOuterCount][2];
  BlockKernel<T> function[kFunctions];
  BlockKernel<T> integer_power;  // b points at the exponent, an integer within +-64
  BlockKernel<T> power[kFormCount];
  BlockKernel<T> copy;
  BlockKernel<T> fill;
  // Adds (a[i] - b[i])^2 to lane (row + i) mod 16 of 16 sums, rows in order; row must be a
  // multiple of 16.
  void (*add_squared_errors)(double* sums, const T* a, const T* b, std::size_t n);
};

// The table of a level that is built in; which those are, kernels_are_built tells.
template <typename T>
const KernelTable<T>& kernel_table(VectorLevel level);
template <>
const KernelTable<double>& kernel_table<double>(VectorLevel level);
template <>
const KernelTable<float>& kernel_table<float>(VectorLevel level);
bool kernels_are_built(VectorLevel level);

// Whether quotients are better formed partly by multiplications (the same bits): Intel's divider
// takes 16 cycles for eight doubles (up to Sapphire Rapids at least), AMD's 5 to 10.
bool divider_is_slow();

}  // namespace tribench
