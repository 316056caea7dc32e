// SPDX-License-Identifier: MIT
//
// uDSR: unified deep symbolic regression (Landajuela et al. 2022), all five parts: a policy network
// trained by reinforcement learning, genetic programming seeded by it, the linear token, recursive
// simplification and pre-training. See README.md for the sources and for where ours differs.
#pragma once

#include <memory>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry udsr_entry();

}  // namespace tribench
