// SPDX-License-Identifier: MIT
//
// A run's folder as a report sees it: finished, unfinished or damaged. Whatever is readable is
// read, whatever is not is said in `complaints`; only a folder without any file of a run is an
// error.
//
// front.csv, trace.csv and curves.csv may be large and are not held here: whoever draws them
// streams them (record_csv.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "reports/record/record.hpp"

namespace tribench {

struct RunFolder {
  std::filesystem::path path;
  std::string name;                  // of the grid, where grid.toml has one; else the folder's
  std::vector<Record> records;       // in the order of comes_before
  std::vector<PlannedCell> missing;  // planned, but without a record
  std::uint64_t budget = 0;          // evaluations of a cell; 0 where it is not known
  std::size_t planned = 0;           // cells the grid asks for; 0 where it is not known
  // provenance.json, flattened: {"sessions.0.machine.cpu", "..."}; in the file's order.
  std::vector<std::pair<std::string, std::string>> provenance;
  std::vector<std::string> complaints;  // what is missing or damaged, one sentence each

  std::size_t failed() const;
  // The value of a flattened provenance key, or empty.
  std::string provenance_of(const std::string& key) const;
};

// Throws Error (bad_input) where the folder does not exist or holds no file of a run.
RunFolder read_run_folder(const std::filesystem::path& folder);

}  // namespace tribench
