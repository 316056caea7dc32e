// SPDX-License-Identifier: MIT
//
// A recorded movement run again by a model, from its first measured position and velocity, and how
// far the model's motion is from the measured one.
//
//   const SimulatedMotion motion = simulate_motion(model, nullptr, movement, {});
//   const MotionErrors errors = motion_errors(movement, motion);
//
// Between rows the drive and the recorded columns are straight lines, or held where the drive is
// commanded by a controller. Everything is in the data's units.
//
// NaN policy: the movement's values must be finite. Where the model has no value the run ends, and
// the rows after it are NaN: it then has no error, and a status that says why.
// Cost: some 1 us a row for a formula of twenty nodes.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "algorithms/forward_dynamics/drive.hpp"
#include "algorithms/forward_dynamics/joint_integrator.hpp"
#include "algorithms/forward_dynamics/joint_model.hpp"

namespace tribench::forward {

// Rows of one movement without a gap, in the order of time, which increases. Views: the data must
// outlive them.
struct MovementRows {
  std::span<const double> time;
  std::span<const double> position;
  std::span<const double> velocity;
  std::span<const double> drive;      // torque or voltage; empty where a controller makes it
  std::span<const double> connected;  // 0: the motor is switched off; empty: it never is
  std::vector<std::span<const double>> recorded;  // of model.inputs.recorded
  std::vector<std::span<const double>> control;   // of controller.columns
};

struct SimulationOptions {
  // Starts again from the measured state every so many seconds; 0: never.
  double horizon_s = 0;
  // The drive and the recorded columns keep a row's value until the next.
  bool hold = false;
  // Of one step, as a share of the movement's range and of its top speed.
  double tolerance = 1e-7;
  double longest_step_s = std::numeric_limits<double>::infinity();
};

struct SimulatedMotion {
  std::vector<double> position;  // a row each
  std::vector<double> velocity;
  std::vector<double> drive;
  std::vector<std::size_t> starts;  // rows at which it was set to the measured state
  MotionStatus status = MotionStatus::complete;
  IntegrationCounts counts;
};

// controller: null where the drive is recorded. Throws Error (bad_input) where the model has no
// inertia.
SimulatedMotion simulate_motion(const JointModel& model, const Controller* controller,
                                const MovementRows& rows, const SimulationOptions& options);

// Simulated less measured, over the rows that are no starts; NaN where the run is not complete.
struct MotionErrors {
  double mean_position = std::numeric_limits<double>::quiet_NaN();  // mean absolute
  double rms_position = std::numeric_limits<double>::quiet_NaN();
  double largest_position = std::numeric_limits<double>::quiet_NaN();
  double mean_velocity = std::numeric_limits<double>::quiet_NaN();
  double rms_velocity = std::numeric_limits<double>::quiet_NaN();
  std::size_t rows = 0;
};
MotionErrors motion_errors(const MovementRows& rows, const SimulatedMotion& motion);

// Stretches of [begin, end) in which no step of time is more than `factor` times the usual (median)
// one, two rows at least.
struct RowStretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};
std::vector<RowStretch> stretches_without_gaps(std::span<const double> time, double factor = 5);

}  // namespace tribench::forward
