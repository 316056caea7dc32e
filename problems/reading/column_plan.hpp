// SPDX-License-Identifier: MIT
//
// What each column of a file is and in which unit: the roles that are given against a row of units
// against the names. Internal to the room.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/csv.hpp"
#include "problems/reading/csv_columns.hpp"

namespace tribench {

struct ColumnPlan {
  ColumnReading reading;
  ColumnKind kind = ColumnKind::found;
  bool used = true;          // a missing value in it is an error
  WrittenUnit unit = {};     // none: not known, or not needed
  std::string unknown_unit;  // written, and no unit that is known
  bool role_given = false;
  int doubt = 0;
  std::optional<int> joint = {};  // the number in the name
  std::string joint_word;         // or what tells the joint otherwise
  bool adds_to_time = false;      // nanoseconds beside a column of seconds
  bool in_chain = false;          // the position of another joint that is asked for
};

// The column is read as one without a role; why, in words.
void lose_role(ColumnPlan& plan, std::string remark);

// Fills the file's warnings and joints too. Throws Error (bad_input) for a role or a use of a
// column that is not there, and for a unit that does not go with its role.
std::vector<ColumnPlan> plan_columns(const CsvLayout& layout, const CsvOptions& options,
                                     std::string_view file, DataFile& out);

void take_unit(ColumnPlan& plan, const WrittenUnit& unit, std::string_view from);

// The column's times are written as text: they are in seconds.
void take_time_text(ColumnPlan& plan);

// Converts a channel to SI and says so in the reading. Time that counts since 1970 (or another
// year) starts at 0.
void convert(ColumnPlan& plan, std::vector<double>& values, const Drive& drive,
             std::string_view file);

}  // namespace tribench
