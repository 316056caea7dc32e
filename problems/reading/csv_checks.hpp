// SPDX-License-Identifier: MIT
//
// What the torques of a file must be to one another once they are read: they share a unit. Cells
// and roles are read in csv.cpp.
#pragma once

#include <string_view>

#include "problems/reading/csv.hpp"

namespace tribench {

// A current beside a motor or friction torque in another unit is what that was computed from: it
// loses the role that only its name gave it.
void demote_current(const CsvOptions& options, DataFile& reading);

// Throws Error (bad_input) where torque-like channels differ in unit. A gravity torque may stand
// in its own unit beside a motor's volts or amperes.
void check_torque_units(const Dataset& data, std::string_view file);

}  // namespace tribench
