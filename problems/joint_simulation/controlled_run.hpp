// SPDX-License-Identifier: MIT
//
// Minutes of a joint under its controller, sample by sample: strokes with limited jerk, reversals
// without a rest, sums of sines, rests, pauses with the brake on. Inertia and gravity are in the
// motor's torque; Coulomb friction passes through a bristle (presliding); one cause more, of
// causes.hpp, may be planted. This is what is true: what sensors and a logger make of it is told by
// harness/study/log_telling.hpp.
//
// Deterministic given the seed; about 0.2 s for two minutes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "problems/friction/planted_data.hpp"

namespace tribench::simulation {

struct ControlledRunPlan {
  std::string cause;  // of causes(); empty: nothing is missing
  double scale = 2;   // root mean square while moving, in standard deviations of the noise
  double seconds = 90;
  double rate_hz = 500;  // divides 1000
  bool gravity = true;   // else the axis is vertical
  bool linear = false;   // in m and N: a fifth of a metre a radian, ten newtons a newton metre
};

struct ControlledRun {
  // Every sample in SI: time, position, velocity, acceleration, gravity_torque, motor_torque; one
  // movement, "run".
  Dataset data;
  std::vector<int> move;  // per row: which stretch of motion, -1 at rest
  // Coulomb friction lags by a bristle in every run: "hysteresis" beside the cause is not wrong.
  std::vector<PlantedEffect> effects;
  double noise_sd = 0;  // of the torque
  double inertia = 0;   // N m s^2/rad, N s^2/m

  // What a careful person would write: the rows in motion, friction_torque for motor_torque.
  Dataset clean() const;
};

// Throws Error (bad_input) for an unknown cause.
ControlledRun run_under_control(const ControlledRunPlan& plan, std::uint64_t seed);

}  // namespace tribench::simulation
