// SPDX-License-Identifier: MIT
#include "problems/reading/csv_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/name_words.hpp"
#include "problems/reading/time_text.hpp"

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

// "11'622.300", "11 622,300", "1.234,5".
bool has_thousands(const BadCell& bad) {
  const bool both = bad.cell.find('.') != std::string::npos || !bad.decimal_comma;
  if (bad.cell.find(',') != std::string::npos && both) return true;
  constexpr std::array<std::string_view, 5> kSigns = {"'", " ", "\xE2\x80\x99", "\xC2\xA0",
                                                      "\xE2\x80\xAF"};
  std::string plain(bad.cell);
  for (const std::string_view sign : kSigns) {
    for (std::size_t at = plain.find(sign); at != std::string::npos; at = plain.find(sign)) {
      plain.erase(at, sign.size());
    }
  }
  double value = 0;
  return plain != bad.cell && read_cell(plain, true, value) == CellKind::number;
}

// "Nm" of "11.6 Nm".
std::string_view unit_behind_number(const BadCell& bad) {
  std::string_view rest = bad.cell;
  rest.remove_prefix(std::min(rest.find_first_not_of("+-0123456789.,"), rest.size()));
  if (bad.kind != CellKind::text || rest.size() == bad.cell.size()) return {};
  rest = trimmed(rest);
  return find_unit(rest) != nullptr ? rest : std::string_view();
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

void demote_current(const CsvOptions& options, std::vector<ColumnPlan>& plans, DataFile& out) {
  for (ColumnPlan& current : plans) {
    ColumnReading& reading = current.reading;
    if (reading.role != Role::motor_current || options.roles.contains(reading.column)) continue;
    for (const ColumnPlan& other : plans) {
      const bool torque =
          other.reading.role == Role::motor_torque || other.reading.role == Role::friction_torque;
      if (!torque || other.unit.unit == nullptr) continue;
      if (current.unit.unit != nullptr && other.unit.unit->si == current.unit.unit->si) continue;
      reading.role = Role::none;
      reading.unit_asked = false;
      reading.remark = fmt::format("'{}' is the torque", other.reading.column);
      out.warnings.push_back(fmt::format("column '{}' is read without a role: '{}' is in {}",
                                         reading.column, other.reading.column,
                                         other.unit.unit->si));
      break;
    }
  }
}

std::string mend_for_cell(const BadCell& bad) {
  std::string list = mend_for_list(bad.column, bad.cell);
  if (!list.empty()) return list;
  if (bad.kind == CellKind::text && bad.is_time && bad.cell.find(':') != std::string::npos) {
    return fmt::format("times that are read: {}", forms_of_time());
  }
  if (bad.kind == CellKind::text && has_thousands(bad)) {
    return "write numbers in one way, and without signs for thousands";
  }
  if (const std::string_view unit = unit_behind_number(bad); !unit.empty()) {
    return read_channel_name(bad.column).unit_written
               ? std::string("write numbers alone: the column's name says the unit")
               : fmt::format("write numbers alone, and the unit into the column's name: '{} [{}]'",
                             bad.column, unit);
  }
  if (bad.kind == CellKind::text && bad.is_time) {
    return fmt::format("times that are read: {}", forms_of_time());
  }
  if (!bad.others_are_read) {
    return fmt::format(
        "no value of the column can be read: write numbers, or say --roles '{}=none'", bad.column);
  }
  if (bad.kind != CellKind::text) return "mend the value, or drop such rows with --drop-missing";
  return bad.drops_missing ? "mend the value, or leave the cell empty: then the row is dropped"
                           : "mend the value, or leave the cell empty and drop such rows with "
                             "--drop-missing";
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
