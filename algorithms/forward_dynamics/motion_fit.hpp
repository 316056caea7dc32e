// SPDX-License-Identifier: MIT
//
// The parameters of a joint from its recorded motion, in two ways:
//
// fit_rigid_body  least squares of the equation of motion, row by row: inertia and the constants of
//                 a gravity that is linear in them, friction being given. Needs a recorded drive
//                 and a measured (or derived) acceleration. One pass.
// fit_to_motion   the simulated positions against the measured ones (output error): any of inertia,
//                 gravity, motor and the friction's constants, by Levenberg-Marquardt from where
//                 they stand. Derivatives by differences: one simulation a parameter and iteration.
//
// Whole-numbered exponents are part of a formula's form and stay.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/forward_dynamics/forward_simulation.hpp"

namespace tribench::forward {

// Slower rows than this part of the top speed are left out of least squares: there the direction of
// friction is not known.
inline constexpr double kSlowestFitted = 0.02;

struct RigidBodyTerms {
  bool inertia = true;
  std::vector<Expression> gravity;  // over q; each gets a coefficient
};

// acceleration[m]: of the rows of movements[m]. Sets model.inertia and model.gravity (the sum of
// the terms; as it was where there are none). Returns the root mean square of what is left, in the
// torque's unit. Throws Error (bad_input) at `place` where the rows do not determine the terms, or
// the inertia comes out negative.
double fit_rigid_body(JointModel& model, const RigidBodyTerms& terms,
                      std::span<const MovementRows> movements,
                      std::span<const std::vector<double>> acceleration, std::string_view place);

struct FreeParameters {
  bool inertia = false;
  bool gravity = false;
  bool motor = false;
  bool friction = false;
};

struct MotionFit {
  double rms_before = 0;  // of the position
  double rms_after = 0;
  int parameters = 0;
  int iterations = 0;
  std::uint64_t simulations = 0;
};

// Moves the model's free parameters; never to a worse root mean square. Where the model has no
// motion to start from nothing is moved and both figures are infinite.
MotionFit fit_to_motion(JointModel& model, const Controller* controller,
                        std::span<const MovementRows> movements, const FreeParameters& free,
                        const SimulationOptions& options, int most_iterations = 30);

}  // namespace tribench::forward
