// SPDX-License-Identifier: MIT
//
// Recorded movements run again by a model: from what a user (or a problem's manifest) says about a
// joint to errors movement by movement. Parameters of the rigid body are fitted to the training
// movements alone; with `refine`, to their simulated motion.
//
//   MotionSetup setup;
//   setup.formula = "8.1*sgn_v + 14*v";
//   setup.inertia = 1.2;
//   const MotionRecord record = try_motion({data}, nullptr, setup, held_out);
//
// What names in the formula mean: algorithms/forward_dynamics/joint_inputs.hpp. Data are SI, with
// the roles time and position, and a motor_torque (a force, a current, a voltage) where no
// controller is given; velocity and acceleration are derived from the position where there are
// none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algorithms/forward_dynamics/joint_model.hpp"
#include "algorithms/forward_dynamics/motion_fit.hpp"
#include "problems/dataset.hpp"
#include "problems/problem.hpp"
#include "reports/record/motion_record.hpp"

namespace tribench {

struct MotionSetup {
  std::string formula;
  std::optional<double> inertia;
  bool fit_inertia = false;  // least squares, else as given
  std::string gravity;       // a formula in q, or forward::kRecordedGravity
  bool is_whole = false;     // the formula is the motor's whole torque: nothing is added to it
  bool fit_gravity = false;  // A sin q + B cos q
  std::optional<forward::Motor> motor;  // the drive is a voltage
  std::string control;                  // a law in place of the recorded drive (drive.hpp)
  std::string limit;
  std::string connected;  // a column: 0 where the motor is switched off
  bool hold = false;
  double horizon_s = 0;
  double tolerance = 1e-7;
  forward::FreeParameters refine;
  // What a position is read in, and how many SI units that is.
  std::string unit = "rad";
  double unit_size = 1;
};

// train: all movements, those with held_out[movement] != 0 take no part in a fit (held_out may be
// empty). test: a further recording, held out as a whole; may be null. Throws Error (bad_input) for
// what is missing, with the option or role that mends it.
MotionRecord try_motion(const Dataset& train, const Dataset* test, const MotionSetup& setup,
                        const std::vector<char>& held_out);

// Mean absolute error of the simulated position, rad or m, over the problem's test movements; NaN
// where the formula holds no inertia, has no value on the way, or leaves the range. problem.motion
// must be there. Throws Error where its data are not.
double motion_error_of(const Problem& problem, const Expression& formula);

// The columns of a dataset as formulas see them.
forward::NamedColumns columns_of(const Dataset& data);

}  // namespace tribench
