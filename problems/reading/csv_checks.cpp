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

// Whether the values change in every row of `restarts` and in no other (restarts[0] is not asked).
template <typename Value>
bool changes_with(const std::vector<Value>& values, const std::vector<char>& restarts) {
  for (std::size_t r = 1; r < values.size(); ++r) {
    if ((values[r] != values[r - 1]) != (restarts[r] != 0)) return false;
  }
  return true;
}

// The column that names the recordings; empty: none does.
std::string column_of_recordings(const DataFile& reading, const Channel& time) {
  std::vector<char> restarts(time.values.size(), 0);
  for (std::size_t r = 1; r < restarts.size(); ++r) {
    restarts[r] = time.values[r] < time.values[r - 1] ? 1 : 0;
  }
  for (const TextColumn& column : reading.texts) {
    if (changes_with(column.values, restarts)) return column.name;
  }
  for (const Channel& channel : reading.data.channels) {
    if (&channel != &time && changes_with(channel.values, restarts)) return channel.name;
  }
  return {};
}

std::string mend_of_time(const DataFile& reading, const Channel& time) {
  if (reading.data.movement_names.size() > 1) return "sort the rows of a movement by time";
  const std::string recordings = column_of_recordings(reading, time);
  if (recordings.empty()) {
    return "sort the rows by time, or name the recordings in a column 'movement'";
  }
  return fmt::format(
      "'{}' changes wherever time begins anew: if it names the recordings, say --roles {}=movement",
      recordings, recordings);
}

// A gravity torque may stand in its own unit beside a motor's volts or amperes: it is a load, and
// the factor between the two is for the model to find.
bool is_load_in_own_unit(const Dataset& data, const Channel& channel) {
  const Channel* motor = data.find(Role::motor_torque);
  if (motor == nullptr) motor = data.find(Role::motor_current);
  return channel.role == Role::gravity_torque && channel.unit.starts_with("N") &&
         motor != nullptr && (motor->unit == "V" || motor->unit == "A");
}

}  // namespace

void check_time(const DataFile& reading, const std::function<std::size_t(std::size_t)>& line_of,
                std::string_view file) {
  const Dataset& data = reading.data;
  const Channel* time = data.find(Role::time);
  if (time == nullptr) return;
  for (std::size_t r = 1; r < data.rows(); ++r) {
    if (data.movement[r] != data.movement[r - 1] || time->values[r] >= time->values[r - 1]) {
      continue;
    }
    throw_bad_input(
        fmt::format("time runs back from {} to {}", time->values[r - 1], time->values[r]),
        csv_place(file, line_of(r), time->name), mend_of_time(reading, *time));
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
