// SPDX-License-Identifier: MIT
#define TRIBENCH_LANE_BYTES 32
#include "algorithms/expression/vector/block_kernels.hpp"

namespace tribench {

extern const KernelTable<double> kKernelsAvx2F64;
extern const KernelTable<float> kKernelsAvx2F32;
constinit const KernelTable<double> kKernelsAvx2F64 = make_kernel_table<double>();
constinit const KernelTable<float> kKernelsAvx2F32 = make_kernel_table<float>();

}  // namespace tribench
