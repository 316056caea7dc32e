// SPDX-License-Identifier: MIT
//
// Recordings with effects planted in them, and the truth about them, whoever generated them.
#pragma once

#include <string>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

struct PlantedEffect {
  std::string family;      // as its generator calls it
  double scale = 0;        // root mean square over all rows, in standard deviations of the noise
  double coefficient = 0;  // of the shape's formula
  // Families of loop.json that name it; empty: no library has it, a diagnosis must say UNKNOWN.
  std::vector<std::string> names;
  std::vector<std::string> beside;  // that may be named beside one of these and are not wrong
  std::vector<Role> lives_in;
  std::vector<double> values;  // [N m], per row
  // Of bristles, relaxed: N m/rad; 0 where there are none.
  double stiffness = 0;

  bool in_library() const { return !names.empty(); }
};

struct PlantedCollision {
  int movement = 0;
  std::size_t first_row = 0;
  std::size_t last_row = 0;
  double peak_nm = 0;
};

struct PlantedTruth {
  std::vector<double> base;   // [N m], per row
  std::vector<double> noise;  // movement offsets and collisions included
  double noise_sd = 0;        // of the rows' noise alone
  std::vector<PlantedEffect> effects;
  std::vector<PlantedCollision> collisions;

  // base + effects: what a perfect model gives.
  std::vector<double> noise_free() const;
};

struct PlantedData {
  Dataset data;  // friction_torque_Nm is the target
  PlantedTruth truth;
};

}  // namespace tribench
