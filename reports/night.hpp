// SPDX-License-Identifier: MIT
//
// What is kept of a run for years: for each method on each problem the errors of its seeds, what
// failed and what it cost. A run's folder holds megabytes, this some ten bytes a cell.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/run_folder.hpp"

namespace tribench {

// A method (operator set) on a problem.
struct NightSeries {
  std::string problem;
  std::string method;
  std::string operators;
  std::size_t cells = 0;
  std::size_t failed = 0;
  std::size_t singular = 0;        // refuted
  double median_error = kMissing;  // on test movements, of the cells that gave a formula
  double cpu_s = kMissing;         // median of a fit
  double evaluations = kMissing;   // median of a fit
  double spread = kMissing;  // of the seeds' log errors, robust standard deviation; three at least
  // Seed and log of the error, six digits; without failed cells and errors of 0.
  std::vector<std::pair<std::uint64_t, float>> log_errors;

  std::string key() const { return problem + "|" + method + "|" + operators; }
};

// A case of a micro-benchmark (harness/benches.hpp): what one turn of its loop cost.
struct NightBench {
  std::string name;                      // "expression_bench interpreter<double>/set:1/rows:200"
  double instructions = kMissing;        // counted under valgrind, as are the misses
  double first_level_misses = kMissing;  // of instructions and data
  double last_level_misses = kMissing;
  double time = kMissing;         // in times of the reference kernel, median of the repetitions
  double time_spread = kMissing;  // of the repetitions, robust standard deviation of the log
};

struct Night {
  std::string name;     // when it started and of which code: sorts by time, names a file
  std::string started;  // UTC, "2026-11-22T02:30:00Z"
  std::string code;     // version and commit
  std::string commit;
  std::string machine;  // the processor
  std::string grid;     // hash of the grid as it took effect
  std::string data;     // hash of the data
  std::string outcome;  // of the comparison with the base: "No regression", "REGRESSION", ...
  std::string bench_conditions;  // of the counts: tool, vector level, caches, C library
  std::vector<NightSeries> series;
  std::vector<NightBench> benches;
};

// `name` names it. Throws Error (bad_input) where the run has no records.
Night night_of_run(const RunFolder& run, std::string name);

// As text with a checksum in its first line; read_night(print_night(n)) gives the same night.
std::string print_night(const Night& night);
// A body with the first line that says what it is: magic and checksum.
std::string night_text(std::string_view body);

// Throws Error (bad_input) with `place` where the text is damaged. Without the seeds' errors (which
// make nine tenths of it) where `with_seeds` is false.
Night read_night(std::string_view text, const std::string& place, bool with_seeds = true);

}  // namespace tribench
