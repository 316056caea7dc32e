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

struct TorqueConstant {
  double value = 0;  // N m/A
  bool at_motor = false;
};

// "0.12", "0.0603@motor". Throws Error (bad_input) with `place`.
TorqueConstant parse_torque_constant(const std::string& text, const std::string& place);

struct DataOptions {
  GivenRoles roles;
  bool names_tell = true;  // false: a column is what `roles` says, and nothing else
  bool drop_missing = false;
  bool flip_sign = false;
  std::string where;  // COLUMN=NUMBER: only these rows
  std::optional<int> joint;
  Drive drive;
  std::optional<TorqueConstant> torque_constant;
};

// The files as one campaign, with the rows that count and the torques' sign turned where asked.
// used: columns that are needed beside those with a role; without a list all are.
// Throws Error (bad_input).
DataFile read_data(std::span<const std::filesystem::path> files, const DataOptions& options,
                   std::optional<std::vector<std::string>> used = {});

}  // namespace tribench
