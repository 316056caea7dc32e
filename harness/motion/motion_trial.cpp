// SPDX-License-Identifier: MIT
#include "harness/motion/motion_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/text.hpp"
#include "algorithms/forward_dynamics/forward_simulation.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "harness/stateful_problem.hpp"
#include "problems/preparation/motion_smoother.hpp"

namespace tribench {
namespace {

using forward::Controller;
using forward::JointModel;
using forward::MovementRows;
using forward::SimulatedMotion;

constexpr std::size_t kTraceRows = 1500;

const std::vector<double>& channel_of(const Dataset& data, Role role) {
  const Channel* channel = data.find(role);
  if (channel == nullptr) {
    throw_bad_input(fmt::format("there is no {}", role_name(role)), data.name,
                    fmt::format("say which column it is: --roles COLUMN={}", role_name(role)));
  }
  return channel->values;
}

// A recording and what is derived from it.
struct Recording {
  const Dataset* data = nullptr;
  std::vector<forward::RowStretch> stretches;  // of all movements
  std::vector<int> movement;                   // of each stretch
  std::vector<double> velocity;
  std::vector<double> acceleration;  // where it is asked for

  Recording(const Dataset& from, bool needs_acceleration) : data(&from) {
    cut();
    const Channel* v = from.find(Role::velocity);
    const Channel* a = from.find(Role::acceleration);
    if (v != nullptr) velocity = v->values;
    if (a != nullptr) acceleration = a->values;
    if (v == nullptr || (a == nullptr && needs_acceleration)) derive(v == nullptr);
  }

  MovementRows rows(std::size_t stretch, const JointModel& model, const Controller* controller,
                    const std::string& connected) const {
    const forward::RowStretch& at = stretches[stretch];
    const auto part = [&](const std::vector<double>& values) {
      return std::span(values).subspan(at.begin, at.end - at.begin);
    };
    MovementRows rows;
    rows.time = part(channel_of(*data, Role::time));
    rows.position = part(channel_of(*data, Role::position));
    rows.velocity = part(velocity);
    if (const Channel* drive = data->find(Role::motor_torque)) rows.drive = part(drive->values);
    if (!connected.empty()) rows.connected = part(data->at(connected).values);
    for (const std::string& name : model.inputs.recorded) {
      rows.recorded.push_back(part(data->at(name).values));
    }
    if (controller != nullptr) {
      for (const std::string& name : controller->columns) {
        rows.control.push_back(part(data->at(name).values));
      }
    }
    return rows;
  }

  std::vector<double> acceleration_of(std::size_t stretch) const {
    const forward::RowStretch& at = stretches[stretch];
    return {acceleration.begin() + static_cast<std::ptrdiff_t>(at.begin),
            acceleration.begin() + static_cast<std::ptrdiff_t>(at.end)};
  }

 private:
  void cut() {
    const std::vector<double>& time = channel_of(*data, Role::time);
    for (std::size_t begin = 0; begin < data->rows();) {
      std::size_t end = begin;
      while (end < data->rows() && data->movement[end] == data->movement[begin]) ++end;
      for (const forward::RowStretch& one :
           forward::stretches_without_gaps(std::span(time).subspan(begin, end - begin))) {
        stretches.push_back({begin + one.begin, begin + one.end});
        movement.push_back(data->movement[begin]);
      }
      begin = end;
    }
  }

  void derive(bool with_velocity) {
    std::vector<RowRange> pieces;
    for (const forward::RowStretch& one : stretches) pieces.push_back({one.begin, one.end});
    const Motion motion =
        MotionSmoother(channel_of(*data, Role::time), channel_of(*data, Role::position), pieces)
            .smoothed();
    if (with_velocity) velocity = motion.velocity;
    if (acceleration.empty()) acceleration = motion.acceleration;
  }
};

// Sums over rows, from which the figures follow.
struct Sums {
  std::size_t movements = 0, rows = 0;
  double position = 0, position2 = 0, largest = 0, velocity = 0, velocity2 = 0, measured2 = 0;
  bool is_whole = true;

  void add(const Sums& more) {
    movements += more.movements;
    rows += more.rows;
    position += more.position;
    position2 += more.position2;
    largest = std::max(largest, more.largest);
    velocity += more.velocity;
    velocity2 += more.velocity2;
    measured2 += more.measured2;
    is_whole = is_whole && more.is_whole;
  }
  MotionFigures figures(double unit) const {
    MotionFigures to;
    to.movements = movements;
    to.rows = rows;
    if (!is_whole || rows == 0) return to;
    const auto n = static_cast<double>(rows);
    to.mean_position = position / n / unit;
    to.rms_position = std::sqrt(position2 / n) / unit;
    to.largest_position = largest / unit;
    to.mean_velocity = velocity / n / unit;
    to.rms_velocity = std::sqrt(velocity2 / n) / unit;
    to.percent_position = 100 * std::sqrt(position2 / measured2);
    return to;
  }
};

class Trial {
 public:
  Trial(const Dataset& train, const Dataset* test, const MotionSetup& setup,
        const std::vector<char>& held_out)
      : setup_(setup), held_out_(held_out) {
    recordings_.emplace_back(train, setup.fit_inertia || setup.fit_gravity);
    if (test != nullptr) recordings_.emplace_back(*test, false);
    make_model(train);
    if (setup.control.empty()) channel_of(train, Role::motor_torque);
  }

  MotionRecord run() {
    fit();
    for (std::size_t r = 0; r < recordings_.size(); ++r) simulate(r);
    record_.held_out = held_out_sums_.figures(setup_.unit_size);
    record_.training = training_sums_.figures(setup_.unit_size);
    describe();
    return std::move(record_);
  }

 private:
  void make_model(const Dataset& data) {
    forward::NamedColumns columns = columns_of(data);
    model_ = forward::parse_joint(setup_.formula, setup_.gravity, columns, "the formula");
    model_.motor = setup_.motor;
    model_.is_whole = setup_.is_whole;
    model_.inertia = setup_.inertia.value_or(0);
    if (setup_.control.empty()) {
      if (!setup_.limit.empty()) {
        throw_bad_input("a limit belongs to a controller", "--limit", "give its law by --control");
      }
      return;
    }
    controller_ = forward::parse_controller(setup_.control, setup_.limit, columns, "--control");
  }

  const Controller* controller() const { return controller_ ? &*controller_ : nullptr; }

  bool is_held_out(std::size_t recording, int movement) const {
    if (recording > 0) return true;
    return !held_out_.empty() && held_out_[static_cast<std::size_t>(movement)] != 0;
  }

  forward::SimulationOptions options() const {
    forward::SimulationOptions options;
    options.horizon_s = setup_.horizon_s;
    options.hold = setup_.hold;
    options.tolerance = setup_.tolerance;
    return options;
  }

  std::vector<std::size_t> training_stretches() const {
    std::vector<std::size_t> all;
    for (std::size_t s = 0; s < recordings_[0].stretches.size(); ++s) {
      if (!is_held_out(0, recordings_[0].movement[s])) all.push_back(s);
    }
    return all;
  }

  void fit() {
    const Recording& from = recordings_[0];
    const std::vector<std::size_t> stretches = training_stretches();
    std::vector<MovementRows> rows;
    for (const std::size_t s : stretches) {
      rows.push_back(from.rows(s, model_, controller(), setup_.connected));
    }
    if (setup_.fit_inertia || setup_.fit_gravity) {
      fit_equation(rows, stretches);
    }
    const forward::FreeParameters& free = setup_.refine;
    if (!free.inertia && !free.gravity && !free.motor && !free.friction) return;
    const forward::MotionFit fit =
        forward::fit_to_motion(model_, controller(), rows, free, options());
    if (!std::isfinite(fit.rms_before)) {
      throw_bad_input("the model has no motion to start from on the training movements", "--refine",
                      "see what it does without: tribench simulate, a shorter --horizon");
    }
    record_.is_refined = true;
    record_.fit = {fit.parameters, fit.iterations, fit.simulations,
                   fit.rms_before / setup_.unit_size, fit.rms_after / setup_.unit_size};
  }

  void fit_equation(const std::vector<MovementRows>& rows,
                    const std::vector<std::size_t>& stretches) {
    const Dataset& data = *recordings_[0].data;
    channel_of(data, Role::motor_torque);  // it is compared with what drives the joint
    if (setup_.fit_gravity && (model_.inputs.uses(forward::Source::gravity) ||
                               model_.inputs.uses(forward::Source::gravity_sign))) {
      throw_bad_input("the formula reads the gravity torque that is to be fitted", "--gravity",
                      "give it as a formula in q");
    }
    forward::RigidBodyTerms terms;
    terms.inertia = setup_.fit_inertia;
    if (setup_.fit_gravity) {
      for (const char* text : {"sin(q)", "cos(q)"}) {
        terms.gravity.push_back(parse(text, std::vector<std::string>{"q"}));
      }
    }
    std::vector<std::vector<double>> acceleration;
    for (const std::size_t s : stretches) {
      acceleration.push_back(recordings_[0].acceleration_of(s));
    }
    const double left = forward::fit_rigid_body(model_, terms, rows, acceleration, "--inertia fit");
    record_.notes.push_back(
        fmt::format("fitted to the equation of motion on {} stretches of training movements: what "
                    "is left is {:.4g} {} rms",
                    rows.size(), left, data.find(Role::motor_torque)->unit));
  }

  void simulate(std::size_t recording) {
    const Recording& from = recordings_[recording];
    for (std::size_t s = 0; s < from.stretches.size();) {
      const int movement = from.movement[s];
      MotionMovement one;
      one.name = from.data->movement_names[static_cast<std::size_t>(movement)];
      one.held_out = is_held_out(recording, movement);
      Sums sums;
      sums.movements = 1;
      for (; s < from.stretches.size() && from.movement[s] == movement; ++s) {
        add_stretch(from, s, one, sums);
      }
      one.figures = sums.figures(setup_.unit_size);
      (one.held_out ? held_out_sums_ : training_sums_).add(sums);
      record_.movements.push_back(std::move(one));
    }
  }

  void add_stretch(const Recording& from, std::size_t stretch, MotionMovement& movement,
                   Sums& sums) {
    const MovementRows rows = from.rows(stretch, model_, controller(), setup_.connected);
    const SimulatedMotion motion = forward::simulate_motion(model_, controller(), rows, options());
    if (motion.status != forward::MotionStatus::complete) {
      sums.is_whole = false;
      movement.broken_off = std::string(forward::motion_status_name(motion.status));
    }
    pushed_ += motion.counts.pushed;
    std::size_t next = 0;
    for (std::size_t i = 0; i < rows.time.size() && sums.is_whole; ++i) {
      if (next < motion.starts.size() && motion.starts[next] == i) {
        ++next;
        continue;
      }
      const double of_q = std::abs(motion.position[i] - rows.position[i]);
      const double of_v = std::abs(motion.velocity[i] - rows.velocity[i]);
      sums.position += of_q;
      sums.position2 += of_q * of_q;
      sums.largest = std::max(sums.largest, of_q);
      sums.velocity += of_v;
      sums.velocity2 += of_v * of_v;
      sums.measured2 += rows.position[i] * rows.position[i];
      ++sums.rows;
    }
    const std::size_t stride = 1 + (from.data->rows() > 0 ? rows.time.size() / kTraceRows : 0);
    for (std::size_t i = 0; i < rows.time.size(); i += stride) {
      movement.trace.time.push_back(rows.time[i]);
      movement.trace.measured.push_back(rows.position[i] / setup_.unit_size);
      movement.trace.simulated.push_back(motion.position[i] / setup_.unit_size);
    }
  }

  void describe() {
    const Dataset& data = *recordings_[0].data;
    record_.title = data.name;
    record_.unit = setup_.unit;
    std::vector<std::string> names;
    const StatefulFormula given = parse_stateful_collecting(setup_.formula, names);
    StatefulFormula fitted = given;
    fitted.formula = model_.friction;
    record_.formula = print_stateful(fitted, std::span(names).first(given.first_state));
    if (model_.inertia > 0) record_.inertia = model_.inertia;
    if (model_.recorded_gravity) record_.gravity = "as recorded";
    if (model_.gravity) record_.gravity = print(*model_.gravity, std::vector<std::string>{"q"});
    if (model_.motor) {
      record_.motor_constant = model_.motor->constant;
      record_.resistance = model_.motor->resistance;
    }
    record_.horizon_s = setup_.horizon_s;
    const Channel* drive = data.find(Role::motor_torque);
    record_.drive = controller_
                        ? fmt::format("a controller: {}{}{}", setup_.control,
                                      setup_.limit.empty() ? "" : ", at most ", setup_.limit)
                        : fmt::format("{} ({}) as recorded{}", drive->name, drive->unit,
                                      setup_.hold ? ", held between rows" : "");
    if (pushed_ > 0) {
      record_.notes.push_back(
          "at a standstill the formula pushes the joint off both ways: it is no friction there "
          "(see: "
          "tribench check --property dissipative)");
    }
  }

  const MotionSetup& setup_;
  const std::vector<char>& held_out_;
  std::vector<Recording> recordings_;
  JointModel model_;
  std::optional<Controller> controller_;
  Sums held_out_sums_;
  Sums training_sums_;
  std::uint64_t pushed_ = 0;
  MotionRecord record_;
};

}  // namespace

forward::NamedColumns columns_of(const Dataset& data) {
  forward::NamedColumns columns;
  for (const Channel& channel : data.channels)
    columns.columns.push_back({channel.name, channel.role});
  return columns;
}

MotionRecord try_motion(const Dataset& train, const Dataset* test, const MotionSetup& setup,
                        const std::vector<char>& held_out) {
  return Trial(train, test, setup, held_out).run();
}

double motion_error_of(const Problem& problem, const Expression& formula) {
  const MotionCase judged = problem.motion();
  MotionSetup setup;
  setup.formula = formula_text(problem, formula);
  setup.inertia = judged.terms.inertia;
  setup.gravity = judged.terms.gravity;
  const Channel* target = judged.test.find(problem.target);
  setup.is_whole = target != nullptr && target->role == Role::motor_torque;
  setup.hold = judged.terms.hold;
  setup.horizon_s = judged.terms.horizon_s;
  try {
    return try_motion(judged.test, nullptr, setup, {}).training.mean_position;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    return std::numeric_limits<double>::quiet_NaN();  // no inertia: no motion
  }
}

}  // namespace tribench
