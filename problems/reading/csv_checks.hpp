// SPDX-License-Identifier: MIT
//
// What the columns of a file must be to one another once they are read: time runs forward in a
// movement, torques share a unit. Cells and roles are read in csv.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "problems/reading/csv.hpp"

namespace tribench {

// Throws Error (bad_input) where time runs back within a movement; line_of: of a row in the file.
// Where a column changes whenever time runs back, the mend names it: it names the recordings.
void check_time(const DataFile& reading, const std::function<std::size_t(std::size_t)>& line_of,
                std::string_view file);

// A current beside a motor or friction torque in another unit is what that was computed from: it
// loses the role that only its name gave it.
void demote_current(const CsvOptions& options, DataFile& reading);

// Throws Error (bad_input) where torque-like channels differ in unit. A gravity torque may stand
// in its own unit beside a motor's volts or amperes.
void check_torque_units(const Dataset& data, std::string_view file);

}  // namespace tribench
