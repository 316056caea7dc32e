// SPDX-License-Identifier: MIT
#include "algorithms/fitting/product_blocking.hpp"

#include <Eigen/Core>

namespace tribench {

void pin_product_blocking() { Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 32 << 20); }

}  // namespace tribench
