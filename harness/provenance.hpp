// SPDX-License-Identifier: MIT
//
// What a run was made with, so that it can be made again and its figures weighed: code, compiler,
// libraries, machine, data, times, and a fingerprint of all results apart from time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/cell_task.hpp"
#include "harness/journal.hpp"
#include "harness/run.hpp"

namespace tribench {

// "0.1.0 (9b8c3ea1f2d4, dirty)"
std::string version_with_commit();

// What a RunIdentity says of the code: version and commit; where the commit does not say it all
// (changes, or none known), a hash of the program itself.
std::string code_identity();

// A hash of everything in the results that time does not touch; equal for equal results in any
// order.
std::string fingerprint(const std::vector<CellResult>& results);
// The same for one cell.
std::string fingerprint(const CellResult& result);

// One invocation of `run` on a folder: a resumed run has several.
struct RunSession {
  std::string started;  // UTC, ISO 8601
  std::string ended;
  std::string command_line;
  RunOptions options;
  RunTally tally;
};

// Writes (or, for a resumed run, brings up to date) provenance.json.
void write_provenance(const std::filesystem::path& folder, const RunIdentity& identity,
                      const RunSession& session, const std::vector<CellResult>& results);

// Of a merged run: the sessions of all its parts.
void write_merged_provenance(const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& parts,
                             const JournalContents& merged);

// "2026-01-31T12:00:00Z"
std::string utc_now();

}  // namespace tribench
