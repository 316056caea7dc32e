// SPDX-License-Identifier: MIT
#include "algorithms/expression/vector/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "algorithms/expression/vector/kernels.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

bool processor_has(VectorLevel level) {
#if defined(__x86_64__)
  switch (level) {
    case VectorLevel::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
    case VectorLevel::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case VectorLevel::baseline:
      break;
  }
  return true;
#else
  return level == VectorLevel::baseline;
#endif
}

VectorLevel chosen_level() {
  const std::vector<VectorLevel>& levels = available_vector_levels();
  const char* wanted = std::getenv("TRIBENCH_VECTOR_LEVEL");
  if (wanted == nullptr || *wanted == '\0') return levels.back();
  std::vector<std::string_view> names;
  for (const VectorLevel level : levels) {
    if (vector_level_name(level) == wanted) return level;
    names.push_back(vector_level_name(level));
  }
  throw_bad_input(fmt::format("the vector level '{}' is not available here", wanted),
                  "TRIBENCH_VECTOR_LEVEL", fmt::format("use one of: {}", fmt::join(names, ", ")));
}

}  // namespace

std::string_view vector_level_name(VectorLevel level) {
  switch (level) {
    case VectorLevel::avx512:
      return "avx512";
    case VectorLevel::avx2:
      return "avx2";
    case VectorLevel::baseline:
      break;
  }
  return "baseline";
}

const std::vector<VectorLevel>& available_vector_levels() {
  static const std::vector<VectorLevel> kLevels = [] {
    std::vector<VectorLevel> levels;
    for (const VectorLevel level :
         {VectorLevel::baseline, VectorLevel::avx2, VectorLevel::avx512}) {
      if (kernels_are_built(level) && processor_has(level)) levels.push_back(level);
    }
    return levels;
  }();
  return kLevels;
}

VectorLevel vector_level() {
  static const VectorLevel kLevel = chosen_level();
  return kLevel;
}

}  // namespace tribench
