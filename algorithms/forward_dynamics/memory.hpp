// SPDX-License-Identifier: MIT
//
// An input of a friction formula that follows from the motion before: distance since the last
// reversal, a filtered velocity, a declared state. The integrator asks what it would be after a
// step that it is still trying, and says when a step is taken.
//
// Not for inputs that follow from this instant alone; those are bound in joint_inputs.hpp.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "algorithms/forward_dynamics/joint_inputs.hpp"
#include "algorithms/states/state_law.hpp"

namespace tribench::forward {

// Where the joint is at the end of a step.
struct Reached {
  double time = 0;
  double position = 0;
  double velocity = 0;
  double gravity = 0;  // torque, 0 where the model knows none
  double motor_torque = 0;
  std::span<const double> recorded = {};
};

class Memory {
 public:
  virtual ~Memory() = default;
  Memory() = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  // Forgets everything; the joint starts here.
  virtual void begin(const Reached& at) = 0;
  // The value dt_s after the last step that was taken, had the joint come there on a straight
  // line. dt_s >= 0.
  virtual double value_at(double dt_s, const Reached& at) const = 0;
  // The step is taken.
  virtual void commit(double dt_s, const Reached& at) = 0;
};

// Of the channels in problems/preparation/derived_channels.hpp, by their names in formulas: "d",
// "d_seen", "v_lag30", "sgn_v_lag20" (any whole number of ms). Null for any other name.
std::unique_ptr<Memory> memory_of(std::string_view name);

// Of a declared state. drives: what each of its law's drives means. Throws Error (bad_input) where
// one is the acceleration or itself a memory.
std::unique_ptr<Memory> memory_of(const StateDeclaration& state, std::span<const Binding> drives);

}  // namespace tribench::forward
