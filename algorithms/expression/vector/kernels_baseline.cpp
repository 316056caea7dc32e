// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 16
#include "algorithms/expression/vector/block_kernels.hpp"

namespace tribench {

extern const KernelTable<double> kKernelsBaselineF64;
extern const KernelTable<float> kKernelsBaselineF32;
constinit const KernelTable<double> kKernelsBaselineF64 = make_kernel_table<double>();
constinit const KernelTable<float> kKernelsBaselineF32 = make_kernel_table<float>();

}  // namespace tribench
