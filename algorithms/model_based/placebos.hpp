// SPDX-License-Identifier: MIT
//
// What any method must beat: `constant`, the mean of the target, and `linear`, least squares in all
// inputs with an offset (inputs that add nothing are left out).
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry constant_entry();
AlgorithmEntry linear_entry();

}  // namespace tribench
