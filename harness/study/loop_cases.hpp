// SPDX-License-Identifier: MIT
//
// The test matrix of the closed loop: every run of the study as what is planted and the seed.
//
// Source: the specification of the closed loop, section 6.1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "problems/kuka/planted.hpp"

namespace tribench {

struct LoopCase {
  std::string group;  // null, hard, constant_velocity, single, outside, pair, collision
  double scale = 0;   // of what is planted, in units of the noise's standard deviation
  kuka::PlantedCase planted;
  std::uint64_t seed = 0;

  // "single/stribeck/0.5/301": names the case everywhere.
  std::string key() const;
};

// null_runs with ordinary noise, a fifth as many with hard noise and with constant velocities
// only; runs_per_cell of each effect at each size, seven halves of that of pairs at each size,
// twice that of bursts at each size. Seeds from first_seed on, one for each case: shared noise
// would make one unlucky campaign count in every cell, and the intervals too narrow.
std::vector<LoopCase> make_loop_cases(int null_runs, int runs_per_cell, std::uint64_t first_seed);

}  // namespace tribench
