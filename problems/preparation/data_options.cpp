// SPDX-License-Identifier: MIT
#include "problems/preparation/data_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "problems/data_problem.hpp"
#include "problems/preparation/chain_gravity.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/explanation.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

// As a cell is written, which may be a bus's 0x1F.
std::optional<double> number_of(std::string_view text) {
  double value = 0;
  if (read_cell(text, false, value) != CellKind::number || !std::isfinite(value)) return {};
  return value;
}

struct Condition {
  std::string column;
  std::string text;
  std::optional<double> value;  // where the text is a number
};

Condition parse_condition(const std::string& text, const std::string& place) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw_bad_input(fmt::format("'{}' is no COLUMN=VALUE", text), place, "as in axis=2");
  }
  std::string wanted = text.substr(equals + 1);
  const std::optional<double> value = number_of(wanted);
  return {text.substr(0, equals), std::move(wanted), value};
}

std::vector<std::size_t> rows_where(const DataFile& file, const Condition& condition,
                                    const std::string& place) {
  std::vector<std::size_t> rows;
  const auto texts = std::ranges::find(file.texts, condition.column, &TextColumn::name);
  if (texts != file.texts.end()) {
    for (std::size_t i = 0; i < texts->values.size(); ++i) {
      if (texts->values[i] == condition.text) rows.push_back(i);
    }
    return rows;
  }
  const auto reading = std::ranges::find(file.readings, condition.column, &ColumnReading::column);
  if (reading != file.readings.end() && reading->role == Role::movement) {
    for (std::size_t i = 0; i < file.data.rows(); ++i) {
      const auto movement = static_cast<std::size_t>(file.data.movement[i]);
      if (file.data.movement_names[movement] == condition.text) rows.push_back(i);
    }
    return rows;
  }
  const std::vector<double>& column =
      at_place(place, [&]() -> const Channel& { return file.data.at(condition.column); }).values;
  if (!condition.value) {
    throw_bad_input(fmt::format("'{}' is no number", condition.text), place,
                    fmt::format("column '{}' holds numbers", condition.column));
  }
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i] == *condition.value) rows.push_back(i);
  }
  return rows;
}

template <typename Values>
void keep(Values& values, const std::vector<std::size_t>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] != i) values[i] = std::move(values[rows[i]]);  // a text moved to itself is empty
  }
  values.resize(rows.size());
}

void keep_rows_where(DataFile& file, const Condition& condition, const std::string& place) {
  const std::vector<std::size_t> rows = rows_where(file, condition, place);
  if (rows.empty()) {
    throw_bad_input(
        fmt::format("no row has {} = {}: none is left", condition.column, condition.text), place,
        "give a value that the column has");
  }
  if (file.in_turn.starts_with(condition.column + " = ")) file.in_turn.clear();
  for (Channel& channel : file.data.channels) keep(channel.values, rows);
  for (TextColumn& text : file.texts) keep(text.values, rows);
  keep(file.data.movement, rows);
}

}  // namespace

void DataOptions::choose_joint(const std::string& text, const std::string& place) {
  if (text.find_first_not_of("0123456789") != std::string::npos) {
    joint_word = text;
    return;
  }
  int number = kMostJoints + 1;
  std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || number > kMostJoints) {
    throw_bad_input(
        fmt::format("'{}' is no joint", text), place,
        fmt::format("a number from 0 to {}, or a word of the columns' names", kMostJoints));
  }
  joint = number;
}

TorqueConstant parse_torque_constant(const std::string& text, const std::string& place) {
  TorqueConstant constant;
  std::string_view number = text;
  constexpr std::string_view kMotor = "@motor";
  if (number.ends_with(kMotor)) {
    constant.at_motor = true;
    number.remove_suffix(kMotor.size());
  }
  const std::optional<double> value = read_number<double>(number);
  if (!value || !(*value > 0)) {
    throw_bad_input(
        fmt::format("'{}' is no torque constant", text), place,
        "write N m/A at the joint, or K@motor beside --gear-ratio, without a sign: that "
        "is turned by --flip-sign");
  }
  constant.value = *value;
  return constant;
}

DataFile read_data(std::span<const std::filesystem::path> files, const DataOptions& options,
                   std::optional<std::vector<std::string>> used, bool spare) {
  std::optional<Condition> condition;
  if (!options.where.empty()) condition = parse_condition(options.where, options.where_place);
  if (condition && used) used->push_back(condition->column);
  const bool chain = !options.urdf.empty();
  CsvOptions csv{options.roles,   options.drop_missing, options.names_tell,
                 std::move(used), options.joint,        options.drive,
                 chain,           options.sample_rate,  spare};
  csv.joint_word = options.joint_word;
  DataFile file = read_csv_files(files, csv);
  if (condition) keep_rows_where(file, *condition, options.where_place);
  if (options.flip_sign) flip_torques(file.data);
  if (!options.urdf.empty()) add_chain_gravity(file, options.urdf);
  return file;
}

DataFile read_named_columns(std::span<const std::filesystem::path> files, DataOptions options,
                            std::optional<std::vector<std::string>> used) {
  options.names_tell = false;
  DataFile file = read_data(files, options, std::move(used));
  check_converted(file);
  for (std::string& one : what_was_converted(file)) file.warnings.push_back(std::move(one));
  if (std::string made = make_torque(file.data, options); !made.empty()) {
    file.warnings.push_back(std::move(made));
  }
  return file;
}

std::string make_torque(Dataset& data, const DataOptions& options) {
  if (!options.torque_constant) return {};
  const auto found = std::ranges::find(data.channels, Role::motor_current, &Channel::role);
  if (found == data.channels.end()) {
    throw_bad_input("there is no motor current", "--torque-constant",
                    "name it: --roles COLUMN=motor_current[A]");
  }
  Channel& current = *found;
  if (current.unit != "A") {
    throw_bad_input(fmt::format("the unit of '{}' is not known", current.name), "--torque-constant",
                    fmt::format("say it: --roles '{}=motor_current[A]' (or mA)", current.name));
  }
  double factor = options.torque_constant->value;
  if (options.torque_constant->at_motor) {
    if (!options.drive.gear_ratio) {
      throw_bad_input("it is of the motor, and nothing says how the gear raises the torque",
                      "--torque-constant", "give --gear-ratio N");
    }
    factor *= *options.drive.gear_ratio;
  }
  for (double& value : current.values) value *= factor;
  current.unit = "N m";
  if (data.find(Role::motor_torque) == nullptr) current.role = Role::motor_torque;
  return fmt::format("torque is {:.6g} N m/A times '{}'", factor, current.name);
}

}  // namespace tribench
