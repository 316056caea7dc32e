// SPDX-License-Identifier: MIT
#include "problems/reading/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "foundation/error.hpp"
#include "problems/reading/joint_columns.hpp"

namespace tribench {
namespace {

bool has(const DataFile& file, std::initializer_list<Role> roles) {
  return std::ranges::any_of(roles, [&](Role role) { return file.data.find(role) != nullptr; });
}

bool is_plain_name(std::string_view name) {
  return name.find_first_of(",=\"[]() ") == std::string_view::npos;
}

}  // namespace

std::vector<std::string> what_is_missing(const DataFile& file) {
  std::vector<std::string> missing;
  if (!file.joints.empty()) {
    missing.push_back(joints_that_stand_here(file) + ": choose one with --joint N");
    return missing;
  }
  if (!file.in_turn.empty()) {
    const std::size_t comma = file.in_turn.find(',');
    std::string one = file.in_turn.substr(0, comma);
    std::erase(one, ' ');
    missing.push_back(
        fmt::format("the rows of several joints stand in turn ({}): choose one with --where '{}'",
                    file.in_turn, one));
  }
  if (!has(file, {Role::friction_torque, Role::motor_torque, Role::motor_current})) {
    missing.emplace_back(
        "there is no friction or motor torque and no motor current: name it with --roles "
        "COLUMN=motor_torque (motor_current, friction_torque)");
  }
  if (!has(file, {Role::velocity, Role::position})) {
    missing.emplace_back(
        "there is no velocity and no position to derive it from: name it with --roles "
        "COLUMN=velocity or COLUMN=position");
  } else if (!has(file, {Role::velocity}) && !has(file, {Role::time})) {
    missing.emplace_back(
        "there is no velocity, and no time to derive it by: name it with --roles COLUMN=time (or, "
        "where the rows are even, --sample-rate HZ)");
  }
  for (const ColumnReading& reading : file.readings) {
    if (!reading.needs.empty()) {
      missing.push_back(
          fmt::format("'{}' is in {}: give {}", reading.column, reading.unit, reading.needs));
    }
    if (!reading.unit_asked) continue;
    missing.push_back(fmt::format("the unit of '{}' ({}) is not known: one of {}", reading.column,
                                  role_name(reading.role), units_of(reading.role)));
  }
  return missing;
}

std::string roles_line(const DataFile& file) {
  std::string line;
  for (const ColumnReading& reading : file.readings) {
    if (reading.role == Role::none) continue;
    const std::string& unit = reading.unit;
    line += fmt::format(
        "{}{}={}{}", line.empty() ? "" : ",",
        is_plain_name(reading.column) ? reading.column : fmt::format("\"{}\"", reading.column),
        role_name(reading.role),
        reading.unit_asked                               ? "[?]"
        : unit.empty() || units_of(reading.role).empty() ? ""
                                                         : fmt::format("[{}]", unit));
  }
  return line;
}

namespace {

// As a shell takes it back, whatever the columns are called.
std::string in_quotes(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string explanation(const DataFile& file) {
  std::size_t width = 6;
  for (const ColumnReading& reading : file.readings) {
    width = std::max(width, reading.column.size());
  }
  std::string text = fmt::format("{:{}}  {:18}  {:10}  {}\n", "column", width, "taken for", "unit",
                                 "from, and what it becomes");
  for (const ColumnReading& reading : file.readings) {
    std::string from = reading.role_from;
    if (!reading.unit_from.empty()) from += fmt::format("; unit: {}", reading.unit_from);
    if (reading.factor != 1) from += fmt::format("; {} (x {:.6g})", reading.si, reading.factor);
    if (!reading.needs.empty()) from += "; needs " + reading.needs;
    if (!reading.remark.empty()) from += (from.empty() ? "" : "; ") + reading.remark;
    const bool used = reading.role != Role::none;
    text += fmt::format("{:{}}  {:18}  {:10}  {}\n", reading.column, width,
                        used ? role_name(reading.role) : "-",
                        reading.unit_asked ? "?" : reading.unit, from);
  }
  text += fmt::format("{} rows", file.data.rows());
  if (file.dropped_rows > 0) text += fmt::format(", {} dropped", file.dropped_rows);
  text += file.has_movements ? fmt::format(", {} movements\n", file.data.movement_names.size())
                             : std::string(", no movement column: strokes are found\n");
  for (const std::string& one : what_is_missing(file)) text += "missing: " + one + "\n";
  const std::string line = roles_line(file);
  if (!line.empty()) text += fmt::format("--roles {}\n", in_quotes(line));
  return text;
}

void check_complete(const DataFile& file) {
  const std::vector<std::string> missing = what_is_missing(file);
  if (missing.empty()) return;
  const std::string line = roles_line(file);
  throw_bad_input(fmt::format("{}", fmt::join(missing, "; ")), file.data.name,
                  line.empty() ? "tribench loop --explain FILE says what each column was taken for"
                               : "so far understood: --roles " + in_quotes(line));
}

void check_converted(const DataFile& file) {
  for (const ColumnReading& reading : file.readings) {
    if (reading.needs.empty()) continue;
    throw_bad_input(fmt::format("'{}' is in {}", reading.column, reading.unit), file.data.name,
                    "give " + reading.needs);
  }
}

std::vector<std::string> what_was_converted(const DataFile& file) {
  std::vector<std::string> lines;
  for (const ColumnReading& reading : file.readings) {
    if (reading.role == Role::none || (reading.factor == 1 && reading.remark.empty())) continue;
    if (reading.unit.empty()) {
      lines.push_back(fmt::format("'{}' is the {}: {}", reading.column, role_name(reading.role),
                                  reading.remark));
      continue;
    }
    lines.push_back(fmt::format("'{}' is the {}, in {} ({}): read as {}{}{}", reading.column,
                                role_name(reading.role), reading.unit, reading.unit_from,
                                reading.si, reading.remark.empty() ? "" : "; ", reading.remark));
  }
  return lines;
}

}  // namespace tribench
