// SPDX-License-Identifier: MIT
//
// The folder of a run: from the journal to the files that reports read, and several folders
// joined into one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/cell_task.hpp"
#include "harness/grid.hpp"
#include "harness/journal.hpp"

namespace tribench {

// Writes grid.toml and planned.csv: what is known before the first cell.
void write_plan_files(const std::filesystem::path& folder, const Grid& grid);

// Writes results.csv, front.csv and trace.csv, in the order of the results' sort, whatever the
// order the cells ended in.
void write_result_files(const std::filesystem::path& folder, std::vector<CellResult> results);

// Joins the journals of runs of the same grid, code and data into `out`, where no run may be yet.
// Throws Error (bad_input) where they differ, with the difference, or where a cell has two
// different results.
JournalContents merge_journals(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& out);

}  // namespace tribench
