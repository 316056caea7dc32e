// SPDX-License-Identifier: MIT
//
// The cases of the study of the closed loop: every run as what is planted, by whom, and the seed.
//
// Source: the specification of the closed loop, section 6.1.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "problems/friction/planted_data.hpp"

namespace tribench {

// Who makes the campaigns: problems/kuka, whose shapes are columns, or problems/joint_simulation,
// whose physics is integrated in time.
enum class LoopGenerator { planted, simulated };

struct LoopCase {
  std::string group;  // null, hard, constant_velocity, single, outside, pair, collision, simulated
  std::string what;   // the planted families or the cause: "stribeck", "drift+lag", "none"
  std::string noise;  // of simulated campaigns: the kind of noise and the design
  std::string design;
  double scale = 0;  // of what is planted, in units of the noise's standard deviation
  std::uint64_t seed = 0;
  double gear_ratio = 1;  // methods are told
  // Signs are drawn, so that an effect may be one that no joint has; simulated physics is possible.
  bool any_sign = true;
  std::function<PlantedData()> make;  // the same data each time; from any thread

  // "single/stribeck/0.5/301", "simulated/load/skewed/mixed/1/7": names the case everywhere.
  std::string key() const;
};

// problems/kuka: null_runs with ordinary noise, a fifth as many with hard noise and with constant
// velocities only; runs_per_cell of each effect at each size, seven halves of that of pairs at each
// size, twice that of bursts at each size. Seeds from first_seed on, one for each case: shared
// noise would make one unlucky campaign count in every cell, and the intervals too narrow.
std::vector<LoopCase> make_loop_cases(int null_runs, int runs_per_cell, std::uint64_t first_seed);

// problems/joint_simulation: null_runs of each kind of noise, runs_per_cell of each cause at 0.5, 1
// and 2 times the noise; designs, and for causes the kind of noise, are drawn evenly. A cause that
// needs reversals is not drawn with movements one way. Seeds as above.
std::vector<LoopCase> make_simulated_cases(int null_runs, int runs_per_cell,
                                           std::uint64_t first_seed);

}  // namespace tribench
