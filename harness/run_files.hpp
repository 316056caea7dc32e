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

// The same from the folder's journal, which is the truth, even of a run that was killed. Returns
// it, with what was damaged in it.
JournalContents rewrite_result_files(const std::filesystem::path& folder);

// Whether a cell failed by what it did to its process, so that running it again costs as much
// again: a crash or a limit.
bool is_harmful(const Record& record);

// Writes quarantine.txt, the keys of such cells, one a line, for `run --quarantine`; removes it
// where there are none.
void write_quarantine_file(const std::filesystem::path& folder,
                           const std::vector<CellResult>& results);

// The globs of such a file; blank lines and those that start with # are left out. Throws Error
// (bad_input) where it cannot be read.
std::vector<std::string> read_quarantine_file(const std::filesystem::path& file);

// Joins the journals of runs of the same grid, code and data into `out`. Throws Error (bad_input)
// where they differ, with the difference, where a cell has two different results, a folder stands
// twice among them or `out` has a run already.
JournalContents merge_journals(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& out);

// The cells of the folder's plan that are not among the results, in its order.
struct PlannedAndMissing {
  std::size_t planned = 0;
  std::vector<std::string> missing;
};
PlannedAndMissing missing_cells(const std::filesystem::path& folder,
                                const std::vector<CellResult>& results);

}  // namespace tribench
