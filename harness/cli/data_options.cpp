// SPDX-License-Identifier: MIT
#include "harness/cli/data_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/number_options.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench {

CLI::Option* add_data_options(CLI::App& command, const std::shared_ptr<DataOptions>& options) {
  command.add_option_function<std::vector<std::string>>(
      "--roles",
      [options](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
          for (const auto& [column, role] : parse_roles(text, "--roles")) {
            if (!options->roles.emplace(column, role).second) {
              throw_bad_input("column '" + column + "' is given two roles", "--roles",
                              "give it one");
            }
          }
        }
      },
      "COLUMN=ROLE[UNIT],... what a column is: q=position[deg], w=velocity[rpm@motor], "
      "i=motor_current[mA], stamp=time[ns]; without [UNIT] as the header says, else SI");
  command.add_option_function<std::string>(
      "--joint", [options](const std::string& text) { options->choose_joint(text, "--joint"); },
      "of several joints in the columns' names: its number (q1 ... q7) or word (elbow_position)");
  command.add_option("--where", options->where, "COLUMN=VALUE: use these rows only");
  command.add_flag("--drop-missing", options->drop_missing, "drop and count incomplete rows");
  command.add_flag("--flip-sign", options->flip_sign, "the file's torques oppose the velocity");
  command
      .add_option("--counts-per-turn", options->drive.counts_per_turn,
                  "of an encoder that is read in counts, after quadrature")
      ->transform(real_number(0, kMostCounts, LowEnd::above));
  command
      .add_option("--sample-rate", options->sample_rate,
                  "rows a second, where they are even and no column is the time")
      ->transform(real_number(0, kLargestSampleRate, LowEnd::above));
  command.add_option_function<std::string>(
      "--torque-constant",
      [options](const std::string& text) {
        options->torque_constant = parse_torque_constant(text, "--torque-constant");
      },
      "K: torque from current, in N m/A at the joint; K@motor: at the motor, times --gear-ratio");
  return command
      .add_option("--gear-ratio", options->drive.gear_ratio, "motor turns per turn of the joint")
      ->transform(real_number(0, kLargestGearRatio, LowEnd::above));
}

Dataset read_columns(const std::string& file, const DataOptions& options,
                     std::vector<std::string> used) {
  const std::vector<std::filesystem::path> files = {file};
  const bool is_any = used.empty();
  DataFile reading =
      read_named_columns(files, options, is_any ? std::nullopt : std::optional(std::move(used)));
  for (const std::string& warning : reading.warnings) {
    print_message(fmt::format("tribench: {}\n", warning));
  }
  if (reading.dropped_rows > 0) {
    print_message(fmt::format("tribench: {}: {} rows with missing values dropped\n", file,
                              reading.dropped_rows));
  }
  return std::move(reading.data);
}

std::vector<std::string> every_other_column(const std::string& file, const DataOptions& options,
                                            const std::string& target,
                                            std::set<std::string> taken) {
  const std::vector<std::filesystem::path> files = {file};
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file)) {
    throw_bad_input("what is no file can be read once only", file, "give --inputs");
  }
  const Dataset data = read_named_columns(files, options, std::nullopt).data;
  data.at(target);
  taken.insert(target);
  std::vector<std::string> columns = user::other_columns(data, std::move(taken), options.where);
  if (columns.empty()) {
    throw_bad_input("no other column holds numbers", file, "there has to be an input");
  }
  print_message(fmt::format("tribench: explained by every other column of numbers: {}\n",
                            fmt::join(columns, ", ")));
  return columns;
}

void require_rule(const std::string& file, const DataOptions& told, const ColumnRule& rule) {
  CsvOptions options{told.roles};
  options.joint = told.joint;
  options.joint_word = told.joint_word;
  options.drive = told.drive;
  options.sample_rate = told.sample_rate;
  options.names_tell = false;
  options.drop_missing = true;
  options.used = std::vector<std::string>{rule.column};
  options.rule = rule;
  read_csv(file, options);
}

}  // namespace tribench
