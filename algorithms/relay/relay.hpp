// SPDX-License-Identifier: MIT
//
// relay: several searches one after the other on the same rows, their formulas on one front. What
// one misses another finds: evolution the short formulas of any form, the policy with its linear
// token sums of many products, the parametric families what has one function of a rational
// argument.
//
// Not a search of its own: it is as good as its members and costs their sum, less what is saved by
// ending where the rows are explained. README.md has the table against the best single member.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry relay_entry();

}  // namespace tribench
