// SPDX-License-Identifier: MIT
//
// What a file must be once it is read: its torques share a unit, its rows are of one joint. Cells
// and roles are read in csv.cpp.
#pragma once

#include <string_view>

#include "problems/reading/csv.hpp"
#include "problems/reading/csv_layout.hpp"

namespace tribench {

// A current beside a motor or friction torque in another unit is what that was computed from: it
// loses the role that only its name gave it.
void demote_current(const CsvOptions& options, DataFile& reading);

// Throws Error (bad_input) where torque-like channels differ in unit. A gravity torque may stand
// in its own unit beside a motor's volts or amperes.
void check_torque_units(const Dataset& data, std::string_view file);

// Says in the file which column tells several joints apart that take turns row by row.
void find_joints_in_turn(const CsvLayout& layout, DataFile& out);

}  // namespace tribench
