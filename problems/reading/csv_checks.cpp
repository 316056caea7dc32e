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

}  // namespace

void demote_current(const CsvOptions& options, DataFile& reading) {
  for (Channel& current : reading.data.channels) {
    if (current.role != Role::motor_current || options.roles.contains(current.name)) continue;
    for (const Channel& other : reading.data.channels) {
      const bool torque = other.role == Role::motor_torque || other.role == Role::friction_torque;
      if (!torque || other.unit == "-" || other.unit == current.unit) continue;
      current.role = Role::none;
      const auto said = std::ranges::find(reading.readings, current.name, &ColumnReading::column);
      said->role = Role::none;
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
