// SPDX-License-Identifier: MIT
//
// What a file was taken for, in words: column by column, what is missing for a diagnosis, and the
// --roles line that says it all.
#pragma once

#include <string>
#include <vector>

#include "problems/reading/csv.hpp"

namespace tribench {

// What a diagnosis of friction cannot do without and does not find, one sentence each; all of it
// at once. Empty: nothing.
std::vector<std::string> what_is_missing(const DataFile& file);

// "q=position[deg],i=motor_current[mA]": what was understood, with [?] where a unit is not known.
std::string roles_line(const DataFile& file);

// A table for people: every column, its role, its unit, from what, what it became.
std::string explanation(const DataFile& file);

// Throws Error (bad_input) with everything that is missing and the line to copy.
void check_complete(const DataFile& file);

// Throws Error (bad_input) where a conversion that was asked for cannot be done; for commands that
// take the columns as they are told.
void check_converted(const DataFile& file);

// One line for a report: "'q' is the position, in deg (header)".
std::vector<std::string> what_was_converted(const DataFile& file);

}  // namespace tribench
