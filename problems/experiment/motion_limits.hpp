// SPDX-License-Identifier: MIT
//
// What a joint that is asked for movements allows, and what it says of itself beforehand: the frame
// in which movements are planned, whoever executes them.
#pragma once

#include <string>
#include <string_view>

#include "problems/experiment/planned_movement.hpp"

namespace tribench {

struct MotionLimits {
  double lowest_rad = -1.5;
  double highest_rad = 1.5;
  double speed_rad_s = 0.6;
  double acceleration_rad_s2 = 3;  // of ramps and approaches
  double torque_nm = 80;           // of the motor: gravity and friction
  double temperature_rise_k = 25;  // of the sensor, over the ambient
  double ambient_degc = 24;        // what the sensor shows before any motion
  double seconds = 600;            // of motion, approaches included
  double least_load_factor = 1;    // on the gravity torque
  double greatest_load_factor = 1;
  double greatest_other_velocity_rad_s = 0;  // of the other joint; 0: it stands still
  double longest_rest_s = 120;
  double rate_hz = 12.5;    // rows a second
  double gear_ratio = 100;  // 0: not known
  // Declared gravity torque: gravity_nm sin(q + gravity_phase_rad), before the load factor.
  double gravity_nm = 0;
  double gravity_phase_rad = 0;
};

// The joint gets to the start of a movement at this part of the speed limit.
inline constexpr double kApproachSpeed = 0.5;

// Where the movement begins and ends.
double start_of(const PlannedMovement& movement);
double end_of(const PlannedMovement& movement);

// Seconds of motion from `position` on: the approach and the movement with its ramps.
double seconds_of(const PlannedMovement& movement, double position_rad, const MotionLimits& limits);

// Position, speed, load factor, other joint, rest and gravity alone against the limits; empty where
// they keep, else what breaks which limit, and the mend.
struct BrokenLimit {
  std::string what;
  std::string mend;
  bool broken() const { return !what.empty(); }
};
BrokenLimit broken_limit(const PlannedMovement& movement, const MotionLimits& limits);

}  // namespace tribench
