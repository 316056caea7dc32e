// SPDX-License-Identifier: MIT
//
// Which columns of a file are those of the one joint that is looked at. Internal to the room.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problems/reading/column_plan.hpp"

namespace tribench {

// Throws Error (bad_input) where two roles have several columns whose names differ by the same
// words before they end alike ("/shoulder/position", "/elbow/position"), unless --roles says whose
// are meant.
void refuse_joints_told_by_words(const std::vector<ColumnPlan>& plans, std::string_view file);

// Of columns that words tell apart (joint_words.hpp) those of one joint count: the one that is
// asked for, else the one whose motion or torque was given its role by hand, else the only one.
// Throws Error (bad_input) with the joints where there are several, or not the one that is asked
// for.
void choose_joint_by_word(const CsvOptions& options, std::vector<ColumnPlan>& plans,
                          std::string_view file, DataFile& out);

// Of columns with numbers in their names those of one joint count: the one that is asked for, else
// the one whose motion or torque was given its role by hand; where there is neither, none, and
// `out` says which there are. The velocity of the joint beside it is the other velocity. Throws
// Error (bad_input) where no column is of the joint.
void choose_joint(const CsvOptions& options, std::vector<ColumnPlan>& plans, DataFile& out);

// "columns of the joints 1, 2 stand here", of a file of which one has to be chosen.
std::string joints_that_stand_here(const DataFile& file);

}  // namespace tribench
