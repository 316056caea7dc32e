// SPDX-License-Identifier: MIT
//
// Data with effects planted in them, and the truth about it: the test matrix of the closed loop.
//
//   const PlantedData run = make_planted({.effects = {{"stribeck", 1.0}}}, seed);
//   run.data            what the robot recorded (friction_torque_Nm is the target)
//   run.truth.effects   what was planted, row by row
//   run.truth.noise     what no model can explain: its mean magnitude is the noise ceiling
//
// The base truth is Coulomb and viscous friction by direction, which every base model holds. The
// same seed gives the same campaign and the same noise whatever is planted. About 5 ms a run.
//
// Source: the specification of the closed loop, sections 6.1 and 8.4.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "problems/friction/planted_data.hpp"

namespace tribench::kuka {

// ordinary: Student t with 5 degrees of freedom, correlation 0.6 of neighbouring rows, sd from 0.5
// to 1 times 0.30 N m with speed, a log-normal factor and an offset (sd 0.045) a movement.
// hard: t with 4, correlation 0.85, sd from 0.1 to 1 times, offset sd 0.09.
enum class NoiseKind { ordinary, hard };

struct Plant {
  std::string family;  // of planted_shapes()
  // The effect's root mean square over all rows, in units of the noise's standard deviation.
  double scale = 1;
};

struct PlantedCase {
  std::vector<Plant> effects;
  NoiseKind noise = NoiseKind::ordinary;
  int constant_velocity = 90;  // movements of A
  int trajectories = 18;       // of D; 0 is A only
  int collisions = 0;          // bursts of 6 rows, each in a movement of its own
  double collision_scale = 8;  // peak, in units of the noise's standard deviation
};

// Channels of loop_campaign.hpp and friction_torque_Nm.
PlantedData make_planted(const PlantedCase& planted, std::uint64_t seed);

// Two different families of the library, drawn with the seed, both at `scale`.
PlantedCase draw_pair(double scale, std::uint64_t seed);

}  // namespace tribench::kuka
