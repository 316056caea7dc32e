// SPDX-License-Identifier: MIT
//
// What a user says about a data file, in a table of a TOML file: the options of the command line
// under the same names, '_' for '-'.
//
//   roles = "q=position[deg],i=motor_current[mA]"    where = "joint=3"    drop_missing = true
//   joint = 2    flip_sign = true    gear_ratio = 100.0    counts_per_turn = 4096.0
//   torque_constant = "0.06@motor"
#pragma once

#include <string>
#include <vector>

#include "foundation/toml_table.hpp"
#include "problems/preparation/data_options.hpp"

namespace tribench {

// For the known keys of the table.
const std::vector<std::string>& data_option_keys();

// Keys that are missing leave their default. Throws Error (bad_input) with the key's place.
DataOptions read_data_options(const TomlTable& table);

// What is not the default, so that reading it gives the same options.
void insert_data_options(toml::table& table, const DataOptions& options);

}  // namespace tribench
