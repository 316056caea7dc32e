// SPDX-License-Identifier: MIT
//
// Datasets A and B as problems of the catalogue, joints 2 and 4:
//
//   A/jN/no_load             averaged A, inputs qd, sgn_qd (Table 1)
//   A/jN/load                raw A, inputs qd, sgn_qd, g, sgn_g (Table 2)
//   B/jN/no_load, B/jN/load  staged (Table 3): stage "fit" is raw A with load, stage "adapt" one
//                            unloaded movement of B with sgn_qd, g, sgn_g; tested on B without and
//                            with a payload
//   B/jN/.../unadapted       the same tests without the second stage
//
// Splits: 10 of A's 90 movements are for testing, one from each of 5 bands of speed in either
// direction. Rows: 40 a movement in training tables, 200 a movement in test tables of A; in B 2000
// for the adaptation and 400 a movement in 10 test movements.
#pragma once

#include <vector>

#include "problems/problem.hpp"

namespace tribench::kuka {

void add_entries(std::vector<ProblemEntry>& entries);

}  // namespace tribench::kuka
