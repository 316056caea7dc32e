// SPDX-License-Identifier: MIT
//
// A worker process seen from the run: gives it cells, holds it to their limits, and says how a
// cell ended when the worker did not. One per thread of the run.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/child_process.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/cell_task.hpp"

namespace tribench {

enum class CellEnd {
  finished,  // the worker answered: the record says ok or failed
  crashed,
  timeout,
  cpu_limit,
  out_of_memory,
  stopped,  // the run was asked to stop: there is no record
};

struct CellOutcome {
  CellEnd end = CellEnd::finished;
  CellResult result;
  bool fresh_worker = false;  // it was the worker's first cell
};

struct WorkerOptions {
  std::vector<std::string> command;  // starts a worker: this program with a hidden subcommand
  int cells_per_worker = 200;        // then a fresh one; leaks and fragments end with it
  std::optional<int> cpu;            // pins the worker to one processor
};

class WorkerProcess {
 public:
  explicit WorkerProcess(WorkerOptions options);
  ~WorkerProcess();

  // Runs one cell to its end, within its limits. `stop` is looked at 20 times a second. Throws
  // Error (failed) where no worker can be started, (environment) where the machine has no room for
  // the cell: that is no result.
  CellOutcome run(const CellTask& task, const std::atomic<bool>& stop);
  // The next cell gets a fresh process.
  void renew();
  int started() const { return started_; }

 private:
  struct Reading;

  void ensure_process();
  CellOutcome wait_for_answer(const CellTask& task, const std::atomic<bool>& stop);
  std::optional<CellEnd> exceeded(const CellTask& task, double wall_s, double cpu_before_s) const;
  CellEnd end_of_process();
  void finish_failed(const CellTask& task, Reading& reading, CellOutcome& outcome);

  WorkerOptions options_;
  std::optional<ScratchFolder> scratch_;  // the worker's temporary files, removed with it
  std::unique_ptr<ChildProcess> process_;
  int cells_run_ = 0;
  int started_ = 0;
  std::string last_end_;  // "SIGSEGV", "exit status 3"
};

}  // namespace tribench
