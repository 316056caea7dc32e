// SPDX-License-Identifier: MIT
//
// Campaigns of a joint simulated in time, with the truth about them: cases for the study of the
// closed loop that share neither motion nor shapes nor noise with problems/kuka, so that nothing is
// tuned to one generator.
//
//   const PlantedData run = simulate({{"presliding_dahl", 1.0}}, NoiseKind::skewed, ...)
//
// Base truth: Coulomb and viscous friction by direction. A lumped thermal model (lubricant heated
// by motion, housing with the sensor behind it). Deterministic given the seed; the same seed gives
// the same motion and the same noise whatever is planted. About 10 ms and 5 500 rows a campaign.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "problems/friction/planted_data.hpp"
#include "problems/joint_simulation/causes.hpp"
#include "problems/joint_simulation/motion.hpp"
#include "problems/joint_simulation/noise.hpp"

namespace tribench::simulation {

struct SimulatedCase {
  std::string cause;  // of causes(); empty: nothing is missing
  double scale = 1;   // root mean square over all rows, in standard deviations of the noise
  NoiseKind noise = NoiseKind::gaussian;
  Design design = Design::mixed;
};

// Channels as of problems/kuka/loop_campaign.hpp. Throws Error (bad_input) for an unknown cause.
PlantedData simulate(const SimulatedCase& wanted, std::uint64_t seed);

}  // namespace tribench::simulation
