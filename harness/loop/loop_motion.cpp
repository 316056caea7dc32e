// SPDX-License-Identifier: MIT
#include "harness/loop/loop_motion.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "algorithms/loop_model/loop_model.hpp"
#include "foundation/error.hpp"
#include "harness/motion/motion_trial.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "problems/reading/units.hpp"
#include "problems/table.hpp"

namespace tribench::loop {
namespace {

constexpr double kAhead_s = 0.5;

// A simulation takes far longer than a diagnosis: it is run on some of a long recording's rows.
constexpr std::size_t kMostRows = 1000;

// Rows from the begin of every movement, so many of each that together they are about kMostRows.
Dataset beginnings(const Dataset& recording) {
  if (recording.rows() <= kMostRows) return recording;
  const std::size_t each = kMostRows / recording.movement_names.size() + 1;
  std::vector<std::size_t> taken(recording.movement_names.size(), 0);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    if (taken[static_cast<std::size_t>(recording.movement[i])]++ < each) rows.push_back(i);
  }
  return select_rows({recording, {}}, rows).data;
}

bool reads(const Expression& formula, const Observations& data, std::string_view name) {
  return std::ranges::any_of(formula.nodes(), [&](const Node& node) {
    return node.is_variable() && data.signals[node.variable].name == name;
  });
}

// Columns under the names of the model's symbols; what follows from the simulated position is left
// out, so that it is computed from that.
void rename_channels(const Observations& data, Dataset& recording) {
  std::erase_if(recording.channels, [](const Channel& channel) {
    return channel.name == "sin_q" || channel.name == "cos_q" ||
           derived_signal(channel.name).has_value();
  });
  for (const Signal& signal : data.signals) {
    if (!signal.recipe.empty() || signal.role == Role::position || signal.role == Role::velocity ||
        signal.role == Role::acceleration) {
      continue;
    }
    for (Channel& channel : recording.channels) {
      // A sign comes from its quantity's column, which keeps its own name.
      if (channel.name == signal.channel && channel.role == signal.role) channel.name = signal.name;
    }
  }
}

double error_of(const LoopModel& model, const Observations& data, const Dataset& recording,
                const std::vector<char>& held_out, MotionSetup setup) {
  const Expression formula = formula_of(model);
  const Signal* t = data.find("t");
  if (t != nullptr && !t->recipe.empty() && reads(formula, data, "t")) return kNoFigure;
  setup.formula = print(formula, data.names());
  setup.fit_inertia = !reads(formula, data, "a");
  try {
    const MotionRecord record = try_motion(recording, nullptr, setup, held_out);
    return (record.held_out.movements > 0 ? record.held_out : record.training).mean_position;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    return kNoFigure;  // nothing to say of its motion
  }
}

}  // namespace

PositionUnit position_unit(const DataFile& file) {
  for (const ColumnReading& reading : file.readings) {
    if (reading.role != Role::position) continue;
    const Unit* unit = find_unit(reading.unit);
    if (unit != nullptr && !unit->counts) return {std::string(unit->symbol), unit->factor};
    return {reading.si, 1};
  }
  return {};
}

LoopMotion loop_motion(const Diagnosis& diagnosis, const Observations& data, Dataset recording,
                       const PositionUnit& unit) {
  LoopMotion motion;
  const Channel* target = recording.find(Role::friction_torque);
  if (target != nullptr || recording.find(Role::position) == nullptr ||
      recording.find(Role::time) == nullptr) {
    return motion;
  }
  const bool is_current = recording.find(Role::motor_torque) == nullptr;
  for (Channel& channel : recording.channels) {
    if (is_current && channel.role == Role::motor_current) channel.role = Role::motor_torque;
  }
  const Channel* drive = recording.find(Role::motor_torque);
  if (drive == nullptr) return motion;
  const Channel* gravity = recording.find(Role::gravity_torque);
  MotionSetup setup;
  setup.is_whole = gravity == nullptr || gravity->unit != drive->unit;
  if (!setup.is_whole) setup.gravity = forward::kRecordedGravity;
  setup.horizon_s = kAhead_s;
  setup.unit_size = unit.si;
  recording = beginnings(recording);
  rename_channels(data, recording);
  std::vector<char> held_out(recording.movement_names.size(), 0);
  for (const int m : diagnosis.held_out) held_out[static_cast<std::size_t>(m)] = 1;
  const double before = error_of(diagnosis.before, data, recording, held_out, setup);
  const double after = error_of(diagnosis.after, data, recording, held_out, setup);
  if (!std::isfinite(before) || !std::isfinite(after)) return motion;
  return {before, after, unit.name, kAhead_s, !diagnosis.held_out.empty()};
}

}  // namespace tribench::loop
