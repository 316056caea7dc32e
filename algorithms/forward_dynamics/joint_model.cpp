// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/joint_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/sign.hpp"

namespace tribench::forward {
namespace {

// Stands for a velocity of 0 of which the direction is known: sgn(v) and v/abs(v) have a value.
constexpr double kBarelyMoving = 1e-150;
constexpr int kMostSecants = 8;
constexpr int kMostDoublings = 40;
constexpr int kMostHalvings = 60;
constexpr double kSolved = 1e-12;    // of the torques in the equation
constexpr double kBalanced = 1e-13;  // of these

int degree_of(Op op, int left, int right) {
  switch (op) {
    case Op::add:
    case Op::sub:
      return std::max(left, right);
    case Op::mul:
      return std::min(2, left + right);
    case Op::div:
      return right == 0 ? left : 2;
    case Op::neg:
      return left;
    default:
      return left == 0 && right == 0 ? 0 : 2;
  }
}

std::vector<std::unique_ptr<Memory>> make_memories(const JointModel& model) {
  std::vector<std::unique_ptr<Memory>> memories;
  for (const std::string& name : model.inputs.memories) {
    const auto state = std::ranges::find(model.states, name, &StateDeclaration::name);
    if (state == model.states.end()) {
      memories.push_back(memory_of(name));
      continue;
    }
    std::vector<Binding> drives;
    for (const std::size_t j : state->drives) drives.push_back(model.inputs.bindings[j]);
    memories.push_back(memory_of(*state, drives));
  }
  return memories;
}

}  // namespace

int degree_in(const Expression& formula, std::size_t column) {
  std::vector<int> stack;
  for (const Node& node : formula.nodes()) {
    if (arity(node.op) == 0) {
      stack.push_back(node.is_variable() && node.variable == column ? 1 : 0);
      continue;
    }
    const int right = arity(node.op) == 2 ? stack.back() : 0;
    if (arity(node.op) == 2) stack.pop_back();
    stack.back() = degree_of(node.op, stack.back(), right);
  }
  return stack.empty() ? 0 : stack.back();
}

JointModel parse_joint(std::string_view friction, std::string_view gravity, NamedColumns columns,
                       std::string_view place) {
  JointModel model;
  const bool is_recorded = gravity == kRecordedGravity;
  if (!gravity.empty() && !is_recorded) {
    model.gravity = parse(gravity, std::vector<std::string>{"q"});
    columns.has_gravity = true;
  }
  std::vector<std::string> names;
  StatefulFormula formula = parse_stateful_collecting(friction, names);
  for (const StateDeclaration& state : formula.states) {
    columns.states.push_back(state.name);
    names.push_back(state.name);
  }
  model.friction = std::move(formula.formula);
  model.states = std::move(formula.states);
  if (is_recorded) {
    const auto column =
        std::ranges::find(columns.columns, Role::gravity_torque, &NamedColumns::Column::role);
    if (column == columns.columns.end()) {
      throw_bad_input("there is no recorded gravity torque", place,
                      "say which column it is: --roles COLUMN=gravity_torque");
    }
    names.push_back(column->name);
  }
  model.inputs = bind_inputs(names, columns, place);
  if (is_recorded) {
    model.recorded_gravity = model.inputs.bindings.back().place;
    model.inputs.bindings.pop_back();
  }
  return model;
}

JointEquation::JointEquation(const JointModel& model, std::string_view place)
    : model_(model), memories_(make_memories(model)), point_(model.inputs.bindings.size(), 0.0) {
  bool reads_acceleration = false;
  for (std::size_t j = 0; j < model.inputs.bindings.size(); ++j) {
    if (model.inputs.bindings[j].source != Source::acceleration) continue;
    acceleration_places_.push_back(j);
    const int degree = degree_in(model.friction, j);
    reads_acceleration = reads_acceleration || degree > 0;
    is_affine_ = is_affine_ && degree < 2;
  }
  if (acceleration_places_.size() > 1) is_affine_ = false;
  if (!reads_acceleration) acceleration_places_.clear();
  if (model.inertia <= 0 && !reads_acceleration) {
    throw_bad_input("the model has no inertia: nothing says how fast a torque moves it", place,
                    "give --inertia (kg m^2, kg), or a formula that reads the acceleration a");
  }
  mass_guess_ = model.inertia > 0 ? model.inertia : 1;
}

double JointEquation::gravity(const JointInstant& at) {
  if (model_.recorded_gravity) return at.recorded[*model_.recorded_gravity];
  if (!model_.gravity) return 0;
  return gravity_evaluator_.evaluate_at(*model_.gravity, std::span(&at.position, 1));
}

double JointEquation::motor_torque(const JointInstant& at) const {
  if (!at.is_connected) return 0;
  if (!model_.motor) return at.drive;
  const Motor& motor = *model_.motor;
  const double current = (at.drive - motor.constant * at.velocity) / motor.resistance;
  return motor.constant * std::clamp(current, -motor.most_current, motor.most_current);
}

void JointEquation::fill(const JointInstant& at, int direction) {
  // A step that is being tried may have passed the standstill: the friction goes on as it was.
  const bool passed = at.velocity * direction <= 0;
  const double velocity = passed ? direction * kBarelyMoving : at.velocity;
  for (std::size_t j = 0; j < point_.size(); ++j) {
    const Binding& binding = model_.inputs.bindings[j];
    double& value = point_[j];
    switch (binding.source) {
      case Source::position:
        value = at.position;
        break;
      case Source::velocity:
        value = velocity;
        break;
      case Source::direction:
        value = direction;
        break;
      case Source::sine:
        value = elementary::sin(at.position);
        break;
      case Source::cosine:
        value = elementary::cos(at.position);
        break;
      case Source::acceleration:
        value = 0;
        break;
      case Source::time:
        value = at.time;
        break;
      case Source::motor_torque:
        value = motor_torque(at);
        break;
      case Source::gravity:
        value = gravity(at);
        break;
      case Source::gravity_sign:
        value = sign(gravity(at));
        break;
      case Source::recorded:
        value = at.recorded[binding.place];
        break;
      case Source::recorded_sign:
        value = sign(at.recorded[binding.place]);
        break;
      case Source::memory:
        value = memories_[binding.place]->value_at(at.since_commit, reached(at));
        break;
    }
  }
}

double JointEquation::friction_at(double acceleration) {
  for (const std::size_t j : acceleration_places_) point_[j] = acceleration;
  return friction_evaluator_.evaluate_at(model_.friction, point_);
}

double JointEquation::friction(const JointInstant& at, int direction, double acceleration) {
  fill(at, direction);
  return friction_at(acceleration);
}

double JointEquation::acceleration(const JointInstant& at, int direction) {
  fill(at, direction);
  const double driving = motor_torque(at) - (model_.is_whole ? 0 : gravity(at));
  const double at_rest = friction_at(0);
  const double free = driving - at_rest;
  if (acceleration_places_.empty()) return free / model_.inertia;
  // Where the torques balance but for rounding no slope can be told.
  const double size = std::abs(driving) + std::abs(at_rest);
  if (std::abs(free) <= kBalanced * size) return free / mass_guess_;
  return solve(driving, free, size);
}

// The root of the residual, which falls with the acceleration: by secants from 0, and where those
// do not get there (the formula jumps at some acceleration) between two signs of the residual.
double JointEquation::solve(double driving, double at_zero, double size) {
  const auto residual = [&](double a) { return driving - model_.inertia * a - friction_at(a); };
  double before = 0;
  double residual_before = at_zero;
  double now = at_zero / mass_guess_;
  for (int step = 0; step < kMostSecants; ++step) {
    const double there = residual(now);
    if (!is_affine_ && std::abs(there) <= kSolved * size) return now;
    const double mass = (residual_before - there) / (now - before);
    if (!(mass > 0)) break;
    mass_guess_ = mass;
    before = now;
    residual_before = there;
    now += there / mass;
    if (is_affine_) return now;
  }
  if (is_affine_) return std::numeric_limits<double>::quiet_NaN();
  double near = 0;  // the residual has the sign that it has at 0
  double far = at_zero / mass_guess_;
  for (int k = 0; k < kMostDoublings && residual(far) * at_zero > 0; ++k) {
    near = far;
    far *= 2;
  }
  if (!(residual(far) * at_zero <= 0)) return std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < kMostHalvings && std::abs(far - near) > kSolved * std::abs(far); ++k) {
    const double middle = 0.5 * (near + far);
    (residual(middle) * at_zero > 0 ? near : far) = middle;
  }
  return 0.5 * (near + far);
}

Reached JointEquation::reached(const JointInstant& at) {
  return {at.time, at.position, at.velocity, gravity(at), motor_torque(at), at.recorded};
}

void JointEquation::begin(const JointInstant& at) {
  if (memories_.empty()) return;
  const Reached here = reached(at);
  for (const auto& memory : memories_) memory->begin(here);
}

void JointEquation::commit(const JointInstant& at) {
  if (memories_.empty()) return;
  const Reached here = reached(at);
  for (const auto& memory : memories_) memory->commit(at.since_commit, here);
}

}  // namespace tribench::forward
