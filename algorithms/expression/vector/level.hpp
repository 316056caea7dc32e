// SPDX-License-Identifier: MIT
//
// Which vector instructions the evaluator uses. One program carries all levels and picks at run
// time what the processor has. Every level gives the same bits (the kernels are one text, with the
// same operations in the same order; a multiply-add that is written is fused on every level), so
// the level is a matter of speed and of provenance, never of results.
#pragma once

#include <string_view>
#include <vector>

namespace tribench {

enum class VectorLevel {
  baseline,  // 16-byte vectors, any processor; fused multiply-add by the C library
  avx2,      // 32-byte vectors with fused multiply-add
  avx512,    // 64-byte vectors (F, DQ, VL, BW)
};

// "baseline", "avx2", "avx512".
std::string_view vector_level_name(VectorLevel level);

// What this processor and this build can run, from the lowest up; never empty.
const std::vector<VectorLevel>& available_vector_levels();

// The level in use: the highest available, or the one that the environment variable
// TRIBENCH_VECTOR_LEVEL names. Throws Error (bad_input) on a name that is unknown or not available
// here. Read once.
VectorLevel vector_level();

}  // namespace tribench
