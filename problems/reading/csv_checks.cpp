// SPDX-License-Identifier: MIT
#include "problems/reading/csv_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"

namespace tribench {
namespace {

// A gravity torque may stand in its own unit beside a motor's volts or amperes: it is a load, and
// the factor between the two is for the model to find.
bool is_load_in_own_unit(const Dataset& data, const Channel& channel) {
  const Channel* motor = data.find(Role::motor_torque);
  if (motor == nullptr) motor = data.find(Role::motor_current);
  return channel.role == Role::gravity_torque && channel.unit.starts_with("N") &&
         motor != nullptr && (motor->unit == "V" || motor->unit == "A");
}

// How many different cells take turns in a column, over and over; 0: they do not.
std::size_t taking_turns(const std::vector<std::vector<std::string>>& rows, std::size_t column) {
  constexpr std::size_t kMostJoints = 16;
  const auto cell = [&](std::size_t row) -> std::string_view {
    return column < rows[row].size() ? std::string_view(rows[row][column]) : std::string_view();
  };
  std::size_t joints = 1;
  while (joints < rows.size() && cell(joints) != cell(0)) ++joints;
  if (joints < 2 || joints > kMostJoints || rows.size() < 3 * joints) return 0;
  for (std::size_t row = joints; row < rows.size(); ++row) {
    if (cell(row) != cell(row - joints)) return 0;
  }
  return joints;
}

}  // namespace

void find_joints_in_turn(const CsvLayout& layout, DataFile& out) {
  for (std::size_t j = 0; j < layout.header.size(); ++j) {
    if (out.readings[j].role != Role::none || !names_joint(layout.header[j])) continue;
    const std::size_t joints = taking_turns(layout.first_rows, j);
    if (joints == 0) continue;
    out.in_turn = layout.header[j] + " = ";
    for (std::size_t k = 0; k < joints; ++k) {
      out.in_turn += (k > 0 ? ", " : "") + layout.first_rows[k][j];
    }
    return;
  }
}

void demote_current(const CsvOptions& options, DataFile& reading) {
  for (Channel& current : reading.data.channels) {
    if (current.role != Role::motor_current || options.roles.contains(current.name)) continue;
    for (const Channel& other : reading.data.channels) {
      const bool torque = other.role == Role::motor_torque || other.role == Role::friction_torque;
      if (!torque || other.unit == "-" || other.unit == current.unit) continue;
      current.role = Role::none;
      const auto said = std::ranges::find(reading.readings, current.name, &ColumnReading::column);
      said->role = Role::none;
      said->unit_asked = false;
      said->remark = fmt::format("'{}' is the torque", other.name);
      reading.warnings.push_back(fmt::format("column '{}' is read without a role: '{}' is in {}",
                                             current.name, other.name, other.unit));
      break;
    }
  }
}

void check_torque_units(const Dataset& data, std::string_view file) {
  const Channel* first = nullptr;
  for (const Channel& channel : data.channels) {
    if (!is_torque_like(channel.role) || channel.unit == "-") continue;
    if (is_load_in_own_unit(data, channel)) continue;
    if (first == nullptr) first = &channel;
    if (channel.unit != first->unit) {
      throw_bad_input(
          fmt::format("'{}' is in {} and '{}' in {}", first->name, first->unit, channel.name,
                      channel.unit),
          file,
          "bring all torque-like columns to one unit, or take the role away from one with "
          "--roles COLUMN=none");
    }
  }
}

}  // namespace tribench
