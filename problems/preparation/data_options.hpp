// SPDX-License-Identifier: MIT
//
// What a user says about a data file, once for every command and for grids: what its columns are,
// in which units, which rows count, what is known of the drive.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "problems/reading/csv.hpp"

namespace tribench {

// What the numbers may be at most.
inline constexpr int kMostJoints = 999;
inline constexpr double kMostCounts = 1e12;
inline constexpr double kLargestGearRatio = 1e6;
inline constexpr double kLargestSampleRate = 1e9;  // Hz

struct TorqueConstant {
  double value = 0;  // N m/A
  bool at_motor = false;
};

// "0.12", "0.0603@motor". Throws Error (bad_input) with `place`.
TorqueConstant parse_torque_constant(const std::string& text, const std::string& place);

struct DataOptions {
  // By its number ("4") or by what the columns' names call it ("elbow"). Throws Error (bad_input)
  // with `place`.
  void choose_joint(const std::string& text, const std::string& place);

  GivenRoles roles;
  bool names_tell = true;  // false: a column is what `roles` says, and nothing else
  bool drop_missing = false;
  bool flip_sign = false;
  std::string where;                    // COLUMN=VALUE, a number or a word: only these rows
  std::string where_place = "--where";  // how messages call it: the option, or its place in a file
  std::optional<int> joint;
  std::string joint_word;           // or what the columns' names call it: "elbow"
  std::filesystem::path urdf = {};  // of the arm, for the gravity torque of `joint`
  Drive drive;
  std::optional<TorqueConstant> torque_constant;
  std::optional<double> sample_rate = {};  // Hz: the rows are even, and no column is the time
};

// The files as one campaign, with the rows that count and the torques' sign turned where asked.
// used: columns that are needed beside those with a role; without a list all are. spare: the others
// are wanted too where they hold numbers throughout. Throws Error (bad_input).
DataFile read_data(std::span<const std::filesystem::path> files, const DataOptions& options,
                   std::optional<std::vector<std::string>> used = {}, bool spare = false);

// Columns that are what the user says they are, for a fit or a problem of a grid: names tell
// nothing, units that were said are converted, current becomes torque where a constant was given
// (`options.names_tell` does not matter). Throws Error (bad_input), also for a unit that waits for
// the counts of a turn or the gear ratio.
DataFile read_named_columns(std::span<const std::filesystem::path> files, DataOptions options,
                            std::optional<std::vector<std::string>> used);

// The motor current becomes the motor torque, in N m; returns the sentence that says so, empty
// where the options hold no torque constant. Throws Error (bad_input): there is no current, its
// unit is not known, the constant is the motor's and there is no gear ratio.
std::string make_torque(Dataset& data, const DataOptions& options);

}  // namespace tribench
