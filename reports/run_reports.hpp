// SPDX-License-Identifier: MIT
//
// Everything that people read about a run, from its folder alone. The harness writes results.csv,
// front.csv, trace.csv, curves.csv and planned.csv (record_csv.hpp) and calls this; so does
// `tribench report` for a run of long ago.
#pragma once

#include <filesystem>
#include <string>

namespace tribench {

// Reads the folder and writes leaderboard.md and report.html beside what it read. Returns the first
// screen of the leaderboard, for the terminal. Throws Error (bad_input) where the folder holds no
// run. base: an earlier run; what changed since then stands on the first screen. Empty: none.
std::string write_run_reports(const std::filesystem::path& folder,
                              const std::filesystem::path& base = {});

// The run as LaTeX tables (latex.hpp); writes nothing.
std::string run_tables_latex(const std::filesystem::path& folder);

}  // namespace tribench
