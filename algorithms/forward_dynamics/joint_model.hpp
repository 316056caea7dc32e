// SPDX-License-Identifier: MIT
//
// The equation of motion of one joint:
//
//   inertia a + gravity(q) + friction(inputs) = tau_m
//
// friction is any formula, positive with velocity. It may read the acceleration (a formula fitted
// to the whole torque of a motor holds the inertia itself); the equation is then solved for a.
// tau_m is the torque that drives the joint, or follows from a voltage at the motor: tau_m = K/R (U
// - K v).
//
// Units are SI or the data's own, as long as they agree; positions in rad or m.
// Not for more than one joint, nor for the step in time: joint_integrator.hpp.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/forward_dynamics/joint_inputs.hpp"
#include "algorithms/forward_dynamics/memory.hpp"
#include "algorithms/states/state_law.hpp"

namespace tribench::forward {

// A motor under a voltage; no inductance: it is faster than the joint.
struct Motor {
  double constant = 0;    // K: N m/A and V s/rad at the joint (N/A and V s/m)
  double resistance = 0;  // ohm
  // The amplifier's limit, A.
  double most_current = std::numeric_limits<double>::infinity();
};

struct JointModel {
  double inertia = 0;                 // kg m^2, kg; 0 where the formula reads the acceleration
  std::optional<Expression> gravity;  // over the one input q
  std::optional<std::size_t> recorded_gravity;  // in its place: a column, among inputs.recorded
  // The formula is the motor's whole torque: gravity is what it reads by that name, and not added.
  bool is_whole = false;
  Expression friction;
  JointInputs inputs;                    // of the friction and of what drives its states
  std::vector<StateDeclaration> states;  // drives are places among `inputs`
  std::optional<Motor> motor;            // the drive is a voltage; else it is a torque
};

// Everything that the equation needs at one instant, beside the direction.
struct JointInstant {
  double time = 0;
  double position = 0;
  double velocity = 0;
  double drive = 0;          // torque, or voltage
  bool is_connected = true;  // else the motor carries no current
  double since_commit = 0;   // s since the memories' last step
  std::span<const double> recorded;
};

// Evaluates it; keeps its workspace. One per thread. The model must outlive this.
class JointEquation {
 public:
  // Throws Error (bad_input) at `place` where the model has no inertia and its formula reads no
  // acceleration.
  JointEquation(const JointModel& model, std::string_view place);

  double gravity(const JointInstant& at);
  double motor_torque(const JointInstant& at) const;
  // Of a joint that slides in `direction` (-1, 1), or is about to: the friction takes that sign at
  // a standstill. Not finite where the formula is not, or where the equation has no solution.
  double acceleration(const JointInstant& at, int direction);
  // The friction at that acceleration.
  double friction(const JointInstant& at, int direction, double acceleration);

  // The memories start here, and make a step of at.since_commit to here.
  void begin(const JointInstant& at);
  void commit(const JointInstant& at);
  const JointModel& model() const { return model_; }

 private:
  void fill(const JointInstant& at, int direction);
  Reached reached(const JointInstant& at);
  double friction_at(double acceleration);
  double solve(double driving, double at_zero, double size);

  const JointModel& model_;
  std::vector<std::unique_ptr<Memory>> memories_;
  Evaluator friction_evaluator_;
  Evaluator gravity_evaluator_;
  std::vector<double> point_;
  std::vector<std::size_t> acceleration_places_;
  bool is_affine_ = true;
  double mass_guess_ = 1;  // of the whole, from the last solution
};

inline constexpr std::string_view kRecordedGravity = "recorded";

// A model from texts: friction (with declared states, where there are any) over `columns`, gravity
// over q, kRecordedGravity (the column with that role), or empty. Throws Error (bad_input) with the
// place and the nearest name.
JointModel parse_joint(std::string_view friction, std::string_view gravity, NamedColumns columns,
                       std::string_view place);

// How a formula depends on a column: 0 not at all, 1 affinely, 2 in any other way.
int degree_in(const Expression& formula, std::size_t column);

}  // namespace tribench::forward
