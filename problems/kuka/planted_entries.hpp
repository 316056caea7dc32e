// SPDX-License-Identifier: MIT
//
// The closed loop's test matrix as problems of the catalogue:
//
//   undeclared/FAMILY/K      one effect at K times the noise, K of 0.25 0.5 1 2 4
//   undeclared/pair/K        two of the library, drawn with the seed, K of 0.5 1 2
//   undeclared/none/ordinary, undeclared/none/hard, undeclared/none/constant_velocity
//   undeclared/collision/8, undeclared/collision/16   bursts, K times the noise
//
// Inputs are all channels with the signs of velocity and gravity torque. One movement in five is
// for testing, drawn with the seed.
#pragma once

#include <vector>

#include "problems/problem.hpp"

namespace tribench::kuka {

void add_planted_entries(std::vector<ProblemEntry>& entries);

}  // namespace tribench::kuka
