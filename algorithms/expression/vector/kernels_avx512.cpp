// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 64
#include "algorithms/expression/vector/block_kernels.hpp"

namespace tribench {

extern const KernelTable<double> kKernelsAvx512F64;
extern const KernelTable<double> kKernelsAvx512MixedF64;
extern const KernelTable<float> kKernelsAvx512MixedF32;
extern const KernelTable<float> kKernelsAvx512F32;
constinit const KernelTable<double> kKernelsAvx512F64 = make_kernel_table<double>();
constinit const KernelTable<double> kKernelsAvx512MixedF64 =
    make_kernel_table<double, Division::mixed>();
constinit const KernelTable<float> kKernelsAvx512F32 = make_kernel_table<float>();
constinit const KernelTable<float> kKernelsAvx512MixedF32 =
    make_kernel_table<float, Division::mixed>();

}  // namespace tribench
