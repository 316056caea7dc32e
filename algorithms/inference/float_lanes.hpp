// SPDX-License-Identifier: MIT
//
// Eight floats that are added at once, in one instruction where the processor has AVX: what sums
// over flips and features are made of. Not for double precision (expression/column_kernels.hpp).
#pragma once

#include <cstddef>

namespace tribench::loop {

inline constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

}  // namespace tribench::loop
