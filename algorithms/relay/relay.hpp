// SPDX-License-Identifier: MIT
//
// relay: searches for structure, then several methods one after the other on the same rows, their
// formulas on one front. Where the law is exact and has structure it is found in milliseconds; what
// one method misses another finds: evolution the short formulas of any form, the policy with its
// linear token sums of many products, the parametric families what has one function of a rational
// argument.
//
// The structure is looked for without noise only. README.md has the table against the best single
// method.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry relay_entry();

}  // namespace tribench
