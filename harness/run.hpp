// SPDX-License-Identifier: MIT
//
// Runs a grid: an OpenMP loop over cells drives worker processes, one a thread, and a journal
// takes what comes of each cell. The results do not depend on the number of threads, the order,
// the shard or on how often the run was interrupted.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "foundation/calibration.hpp"
#include "harness/grid.hpp"
#include "harness/journal.hpp"
#include "harness/plan.hpp"

namespace tribench {

struct RunOptions {
  std::filesystem::path out;
  std::string data;  // folder of the measured sets; may be empty
  int jobs = 1;      // worker processes at a time
  Shard shard;
  bool resume = false;
  bool pin = false;    // each worker to a processor of its own
  bool quiet = false;  // no progress line
  std::vector<std::string> worker_command;
  std::set<std::string> only;  // keys of the cells to run; empty: all of the shard
  MeasuredCosts costs;
};

struct RunTally {
  std::size_t cells = 0;   // of the shard
  std::size_t found = 0;   // done before, by the run that is resumed
  std::size_t ran = 0;     // now
  std::size_t failed = 0;  // of all that are done
  std::size_t retries = 0;
  std::size_t contended = 0;  // fits that had the processor for less than 80 % of their time
  std::size_t workers = 0;    // processes started
  bool stopped = false;       // asked to stop before the end
  double wall_s = 0;
  double fit_wall_s = 0;  // of all fits together
  double fit_cpu_s = 0;
  std::vector<CalibrationSample> calibration;
  std::vector<std::string> journal_damage;

  std::size_t done() const { return found + ran; }
};

// Every problem's data as one hash; throws Error where a problem cannot be made, (bad_input) where
// a prior names an input that none of them has.
std::string data_identity(const Grid& grid, const std::string& data);

// Runs what the folder's journal does not have yet. Throws Error (bad_input) where the folder
// holds another run, (failed) where the disk is full; what was done stays done.
RunTally run_grid(const Grid& grid, const RunOptions& options, const RunIdentity& identity,
                  const std::atomic<bool>& stop);

}  // namespace tribench
