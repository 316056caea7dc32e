// SPDX-License-Identifier: MIT
//
// What a simulator's joint can take of a friction formula: a Coulomb level, a viscous coefficient
// and, where the formula reads the acceleration, an armature, fitted over the box by least squares;
// and what that loses, in torque and in motion.
//
//   mujoco  <joint frictionloss damping armature>            MuJoCo XML reference, joint
//   urdf    <dynamics friction damping>                      URDF, joint
//   isaac   static, dynamic and viscous friction, armature   PhysX 5, PxJointFrictionParams
//
// Velocities count alike, the other inputs evenly over the box. States stand where a constant
// velocity brings them; what they remember is lost.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/input_box.hpp"

namespace tribench {

enum class Simulator { mujoco, urdf, isaac };
const std::vector<std::string>& simulator_names();  // "mujoco", "urdf", "isaac"
std::optional<Simulator> find_simulator(std::string_view name);

struct LostFriction {
  std::string what;  // "the difference between the directions"
  double rms = 0;    // torque; of an input, about the mean over its range
};

struct SimulatorFriction {
  double coulomb = 0;
  double viscous = 0;
  double armature = 0;    // 0 where the formula reads no acceleration
  double breakaway = 0;   // mean over the box of the friction as motion begins
  double rms = 0;         // of the formula over the box
  double mean_error = 0;  // mean absolute, over the box
  double worst_error = 0;
  std::string worst_at;  // "v=0.02, g=-30"
  std::vector<LostFriction> lost;
  bool remembers = false;
  // A joint of that inertia, driven by the torque under which the formula follows a sine of half
  // the box's top speed and two seconds: how far it is off over one period with these parameters.
  std::optional<double> inertia;
  double mean_motion = 0;
  double largest_motion = 0;
  double amplitude = 0;  // of the sine
  std::string formula;   // the same friction, to be simulated on data
};

// velocity, acceleration: what they are called in the box (acceleration may be absent). Throws
// Error (bad_input): the velocity has no range with 0 inside, the formula has no value somewhere.
SimulatorFriction fit_simulator_friction(std::string_view formula, NamedBox box,
                                         const std::string& velocity,
                                         const std::string& acceleration, Simulator simulator,
                                         std::optional<double> inertia);

// A whole, well-formed file: MJCF with a default class, URDF with one joint, USD with a layer over
// a joint. is_linear: a slide (N, m), else a hinge (N m, rad). Throws Error (bad_input) where
// `joint` is no plain name.
std::string simulator_text(const SimulatorFriction& friction, Simulator simulator,
                           std::string_view formula, const std::string& joint, bool is_linear);

}  // namespace tribench
