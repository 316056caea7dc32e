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
//   A/jN/channels            raw A, every channel as an input, for the closed loop
//
// Splits: 10 of A's 90 movements are for testing, one from each of 5 bands of speed in either
// direction. Rows: 40 a movement in training tables, 200 a movement in test tables of A; in B 2000
// for the adaptation and 400 a movement in 10 test movements.
#pragma once

#include <cstdint>
#include <vector>

#include "problems/kuka/joint.hpp"
#include "problems/problem.hpp"
#include "problems/table.hpp"

namespace tribench::kuka {

void add_entries(std::vector<ProblemEntry>& entries);

// The one unloaded movement of B that the stage "adapt" sees.
KnownDataset make_adaptation_movement(const Joint& joint, std::uint64_t seed);
// The movements of B that are tested on, with or without the payload.
KnownDataset make_b_test(const Joint& joint, std::uint64_t seed, bool load);

}  // namespace tribench::kuka
