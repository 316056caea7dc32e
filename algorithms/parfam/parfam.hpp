// SPDX-License-Identifier: MIT
//
// ParFam (Scholl et al. 2023, 2025): symbolic regression by continuous optimisation over
// parametric families. See README.md beside this file.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry parfam_entry();

}  // namespace tribench
