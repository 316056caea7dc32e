// SPDX-License-Identifier: MIT
//
// Data with a known answer for the tests of the diagnosis: 90 movements at constant velocity and
// 18 two-tone trajectories of a joint with Coulomb and viscous friction by direction, correlated
// heavy-tailed noise, and effects planted on top.
#pragma once

#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"

namespace tribench {

struct Planting {
  std::string effect;  // a family's name, "v_bump", "q_bump", "tq_interaction", "oscillation"
  double size = 1;     // rms, in noise standard deviations
};

struct PlantedOptions {
  std::vector<Planting> effects;
  bool hard_noise = false;
  bool only_constant_velocity = false;
  int collisions = 0;
  double collision_size = 16;  // noise standard deviations
};

struct PlantedData {
  Dataset data;
  std::vector<double> truth;  // friction without noise
};

PlantedData make_planted(const PlantedOptions& options, std::uint64_t seed);

}  // namespace tribench
