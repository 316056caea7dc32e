// SPDX-License-Identifier: MIT
//
// What a file must be: its torques share a unit, its rows are of one joint, its cells are numbers,
// with the mend of one that is none. Cells and roles are read in csv.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/column_plan.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_layout.hpp"

namespace tribench {

// A current beside a motor or friction torque in another unit is what that was computed from: it
// loses the role that only its name gave it, and what it lacks is no matter.
void demote_current(const CsvOptions& options, std::vector<ColumnPlan>& plans, DataFile& out);

// A cell that is no number, or too large for one, in a column that is used.
struct BadCell {
  std::string_view column;
  std::string_view cell;
  CellKind kind = CellKind::text;
  bool decimal_comma = false;
  bool is_time = false;          // the column's role
  bool others_are_read = false;  // of the same column
  bool drops_missing = false;    // --drop-missing is given
};
std::string mend_for_cell(const BadCell& bad);

// Throws Error (bad_input) where torque-like channels differ in unit. A gravity torque may stand
// in its own unit beside a motor's volts or amperes.
void check_torque_units(const Dataset& data, std::string_view file);

// Says in the file which column tells several joints apart that take turns row by row.
void find_joints_in_turn(const CsvLayout& layout, DataFile& out);

}  // namespace tribench
