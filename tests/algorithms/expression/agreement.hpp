// SPDX-License-Identifier: MIT
//
// Draws random formulas and expects that every way of evaluating them agrees:
//
//   interpreter on all vector levels, compiled code on all levels   the same bits
//   the formula printed and parsed again                            the same bits
//   plain recursion with our functions                              the same bits
//   plain recursion with the C library (double)     within 4 ulp an operation, and finite together
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace tribench {

// The same bits; any NaN is any other.
template <typename T>
bool same(T a, T b) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

// GoogleTest expectations; stops at the first formula that differs.
template <typename T>
void expect_agreement(std::uint64_t seed, int formulas);

extern template void expect_agreement<double>(std::uint64_t seed, int formulas);
extern template void expect_agreement<float>(std::uint64_t seed, int formulas);

}  // namespace tribench
