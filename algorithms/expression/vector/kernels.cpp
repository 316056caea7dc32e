// SPDX-License-Identifier: MIT
#include "algorithms/expression/vector/kernels.hpp"

#include "algorithms/expression/vector/level.hpp"

namespace tribench {

extern const KernelTable<double> kKernelsBaselineF64;
extern const KernelTable<float> kKernelsBaselineF32;
#if defined(__x86_64__)
extern const KernelTable<double> kKernelsAvx2F64;
extern const KernelTable<float> kKernelsAvx2F32;
extern const KernelTable<double> kKernelsAvx512F64;
extern const KernelTable<float> kKernelsAvx512F32;
// Quotients partly by multiplications: the same bits, faster where the divider is slow.
extern const KernelTable<double> kKernelsAvx512MixedF64;
extern const KernelTable<float> kKernelsAvx512MixedF32;
#endif

bool divider_is_slow() {
#if defined(__x86_64__)
  return __builtin_cpu_is("intel");
#else
  return false;
#endif
}

template <>
const KernelTable<double>& kernel_table<double>(VectorLevel level) {
#if defined(__x86_64__)
  if (level == VectorLevel::avx512) {
    return divider_is_slow() ? kKernelsAvx512MixedF64 : kKernelsAvx512F64;
  }
  if (level == VectorLevel::avx2) return kKernelsAvx2F64;
#endif
  return kKernelsBaselineF64;
}

template <>
const KernelTable<float>& kernel_table<float>(VectorLevel level) {
#if defined(__x86_64__)
  if (level == VectorLevel::avx512) {
    return divider_is_slow() ? kKernelsAvx512MixedF32 : kKernelsAvx512F32;
  }
  if (level == VectorLevel::avx2) return kKernelsAvx2F32;
#endif
  return kKernelsBaselineF32;
}

bool kernels_are_built(VectorLevel level) {
#if defined(__x86_64__)
  return level <= VectorLevel::avx512;
#else
  return level == VectorLevel::baseline;
#endif
}

}  // namespace tribench
