// SPDX-License-Identifier: MIT
//
// What simulating recorded movements gave: errors, the model, the traces of a picture. Positions
// are in `unit`, velocities in `unit`/s, already converted to what the user reads; times in s. A
// figure that does not exist is NaN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tribench {

inline constexpr double kNoMotion = std::numeric_limits<double>::quiet_NaN();

struct MotionFigures {
  std::size_t movements = 0;
  std::size_t rows = 0;
  double mean_position = kNoMotion;  // mean absolute, over rows
  double rms_position = kNoMotion;
  double largest_position = kNoMotion;
  double mean_velocity = kNoMotion;
  double rms_velocity = kNoMotion;
  double percent_position = kNoMotion;  // 100 |simulated - measured| / |measured|, 2-norms
};

struct MotionTrace {
  std::vector<double> time;  // thinned evenly
  std::vector<double> measured;
  std::vector<double> simulated;
};

struct MotionMovement {
  std::string name;
  bool held_out = false;
  std::string broken_off;  // why there is no figure; empty where it was simulated to its end
  MotionFigures figures;
  MotionTrace trace;
};

// Of parameters fitted to the simulated motion.
struct MotionFitRecord {
  int parameters = 0;
  int iterations = 0;
  std::uint64_t simulations = 0;
  double rms_before = kNoMotion;  // of the position, on training movements
  double rms_after = kNoMotion;
};

struct MotionRecord {
  std::string title;
  std::string unit;
  std::string formula;
  double inertia = kNoMotion;
  std::string gravity;  // a formula in q; empty where there is none
  double motor_constant = kNoMotion;
  double resistance = kNoMotion;
  std::string drive;  // in words
  double horizon_s = 0;
  MotionFigures held_out;
  MotionFigures training;
  std::vector<MotionMovement> movements;
  bool is_refined = false;
  MotionFitRecord fit;
  std::vector<std::string> notes;
};

}  // namespace tribench
