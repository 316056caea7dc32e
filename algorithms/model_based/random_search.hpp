// SPDX-License-Identifier: MIT
//
// `random_search`: a placebo. Draws formulas over the operator set at random, gives each the best
// offset and factor, and keeps the best of each size. No selection, no variation, no memory: what a
// search wins over it, it wins by searching.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry random_search_entry();

}  // namespace tribench
