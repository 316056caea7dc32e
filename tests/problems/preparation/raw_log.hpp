// SPDX-License-Identifier: MIT
//
// Logs as robots write them, made from one physics: a joint under a motor's torque with friction
// that has a presliding state, integrated in time; told once cleanly (a table with every channel,
// SI, movements named) and once raw (encoder counts, a filtered velocity, a current with correlated
// noise, stamps, rests, lost messages).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tribench::testing {

struct RawLogPlan {
  std::uint64_t seed = 1;
  double seconds = 60;
  double step = 0.002;            // s
  int encoder_bits = 16;          // counts a turn of the joint: 2^bits
  double gravity = 15;            // N m at the horizontal
  double load = 0;                // share of |gravity| that goes into Coulomb friction
  double stribeck = 0;            // N m above Coulomb friction at standstill
  double ripple = 0;              // N m, twice a motor turn at a ratio of 100
  double torque_constant = 8;     // N m/A
  double noise = 0.2;             // N m, standard deviation of the torque's correlated noise
  double velocity_filter = 0.01;  // s
};

struct RawSample {
  double time = 0;
  double position = 0;
  double velocity = 0;
  double filtered_velocity = 0;
  double acceleration = 0;
  double gravity = 0;
  double torque = 0;  // the motor's, with noise
  int movement = 0;   // 0: at rest
};

std::vector<RawSample> simulate(const RawLogPlan& plan);

// What a careful person would make of it.
std::string clean_table(const std::vector<RawSample>& samples);

struct RawTelling {
  bool velocity = false;       // a column of it, filtered, deg/s
  bool gravity = false;        // a column of it
  bool counts = false;         // position in counts, else in degrees
  bool decimal_comma = false;  // with semicolons
  bool units_row = false;      // units in a row of their own, else in brackets
  bool losses = false;         // stretches of 50 rows are missing
};
std::string raw_table(const std::vector<RawSample>& samples, const RawLogPlan& plan,
                      const RawTelling& telling);

}  // namespace tribench::testing
