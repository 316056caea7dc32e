// SPDX-License-Identifier: MIT
//
// As many floats as one instruction adds on processors with AVX; others take two. Not for sums
// whose bits matter: the tests that count flips compare sums with a tolerance.
#pragma once

#include <cstddef>

namespace tribench::loop {

inline constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

}  // namespace tribench::loop
