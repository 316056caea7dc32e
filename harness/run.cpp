// SPDX-License-Identifier: MIT
#include "harness/run.hpp"
#include "harness/catalogue.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <set>

#include "foundation/error.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/suggestion.hpp"
#include "harness/cell_task.hpp"
#include "harness/progress_line.hpp"
#include "harness/run_files.hpp"
#include "harness/worker_process.hpp"

namespace tribench {
namespace {

constexpr double kSecondsBetweenCalibrations = 60;
constexpr double kContendedUtilisation = 0.8;
// Shorter fits have no utilisation to speak of: clocks and scheduling dominate.
constexpr double kLeastMeasuredWall = 0.02;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int retries_allowed(const RetryPolicy& retry, const CellOutcome& outcome) {
  switch (outcome.end) {
    case CellEnd::crashed:
      return retry.crashed;
    case CellEnd::timeout:
      return retry.timeout;
    case CellEnd::cpu_limit:
      return retry.cpu_limit;
    case CellEnd::out_of_memory:
      return retry.out_of_memory;
    case CellEnd::stopped:
      return 0;
    case CellEnd::finished:
      break;
  }
  return outcome.result.record.reason.kind == FailureKind::error ? retry.error : 0;
}

// A worker that has run other cells may have been spoilt by them: that is no fault of this cell.
bool blames_the_worker(const CellOutcome& outcome) {
  return !outcome.fresh_worker &&
         (outcome.end == CellEnd::crashed || outcome.end == CellEnd::out_of_memory);
}

std::vector<int> available_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return processors;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &set)) processors.push_back(cpu);
  }
  return processors;
}

// The loop over cells and what its threads share.
class GridRun {
 public:
  GridRun(const Grid& grid, const RunOptions& options, Journal& journal, RunTally& tally,
          const std::atomic<bool>& stop)
      : grid_(grid), options_(options), journal_(journal), tally_(tally), stop_(stop) {}

  void run(const std::vector<PlannedWork>& work) {
    double predicted_s = 0;
    for (const PlannedWork& item : work) predicted_s += item.predicted_s;
    ProgressLine progress(work.size(), predicted_s, options_.quiet);
    const int jobs = std::max(1, std::min(options_.jobs, static_cast<int>(work.size())));
    // Cells first; only where there are fewer cells than jobs may a cell use several threads.
    threads_per_cell_ = std::max(1, options_.jobs / std::max(1, jobs));
    const std::vector<int> processors = available_processors();
    const bool pins = options_.pin && jobs <= static_cast<int>(processors.size());
    sample_calibration();
    const auto count = static_cast<std::ptrdiff_t>(work.size());
#pragma omp parallel num_threads(jobs)
    {
      WorkerOptions worker_options{options_.worker_command, 200, std::nullopt};
      const int thread = omp_get_thread_num();
      if (pins) worker_options.cpu = processors[static_cast<std::size_t>(thread)];
      WorkerProcess worker(worker_options);
#pragma omp for schedule(dynamic, 1) nowait
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        if (must_end()) continue;
        run_one(work[static_cast<std::size_t>(i)], worker, progress);
        if (thread == 0) calibrate_if_due();
      }
      const std::lock_guard lock(mutex_);
      tally_.workers += static_cast<std::size_t>(worker.started());
    }
    sample_calibration();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  bool must_end() const { return stop_.load() || has_failed_.load(); }

  // No exception may leave the parallel region: the first is kept and thrown after it.
  void run_one(const PlannedWork& item, WorkerProcess& worker, ProgressLine& progress) {
    try {
      const std::optional<CellResult> result = result_of(item.cell, worker);
      if (!result) return;
      journal_.append(*result);
      const bool failed = !is_ok(result->record);
      count(result->record, failed);
      progress.cell_ended(item.predicted_s, failed);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      has_failed_ = true;
    }
  }

  std::optional<CellResult> result_of(const Cell& cell, WorkerProcess& worker) {
    if (grid_.quarantined(cell)) {
      CellResult result;
      result.record = empty_record(cell);
      mark_failed(result.record, FailureKind::quarantined);
      return result;
    }
    CellTask task = make_task(grid_, cell, options_.data);
    task.threads = threads_per_cell_;
    for (int used = 0;;) {
      CellOutcome outcome = worker.run(task, stop_);
      if (outcome.end == CellEnd::stopped) return std::nullopt;
      const bool is_done = outcome.end == CellEnd::finished &&
                           outcome.result.record.reason.kind != FailureKind::error;
      if (is_done) return std::move(outcome.result);
      if (!blames_the_worker(outcome) && used++ >= retries_allowed(grid_.retry, outcome)) {
        return std::move(outcome.result);
      }
      worker.renew();
      const std::lock_guard lock(mutex_);
      ++tally_.retries;
    }
  }

  void count(const Record& record, bool failed) {
    const std::lock_guard lock(mutex_);
    ++tally_.ran;
    if (failed) ++tally_.failed;
    if (record.fit_cpu_s > 0 && record.fit_wall_s > kLeastMeasuredWall) {
      tally_.fit_cpu_s += record.fit_cpu_s;
      tally_.fit_wall_s += record.fit_wall_s;
      if (record.fit_cpu_s < kContendedUtilisation * record.fit_wall_s) ++tally_.contended;
    }
  }

  void sample_calibration() {
    CalibrationSample sample = calibrate();
    sample.at_s = seconds_since(start_);
    tally_.calibration.push_back(sample);
  }

  void calibrate_if_due() {
    if (seconds_since(start_) - tally_.calibration.back().at_s > kSecondsBetweenCalibrations) {
      sample_calibration();
    }
  }

  const Grid& grid_;
  const RunOptions& options_;
  Journal& journal_;
  RunTally& tally_;
  const std::atomic<bool>& stop_;
  Clock::time_point start_ = Clock::now();
  int threads_per_cell_ = 1;
  std::atomic<bool> has_failed_{false};
  std::exception_ptr failure_;
  std::mutex mutex_;
};

void hash_values(const std::vector<double>& values, std::uint64_t& hash) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                               values.size() * sizeof(double));
  hash = key_of(fmt::format("{:016x}{:016x}", hash, key_of(bytes)));
}

void hash_table(const Table& table, std::uint64_t& hash) {
  for (const std::vector<double>& column : table.columns) hash_values(column, hash);
  hash_values(table.target, hash);
}

void require_known_inputs(const Prior& prior, const std::vector<std::string>& inputs) {
  for (const auto& [name, degree] : prior.max_degree) {
    if (std::ranges::count(inputs, name) > 0) continue;
    throw_bad_input(fmt::format("no problem of the grid has an input '{}'", name),
                    "[prior] max_degree", did_you_mean(name, inputs));
  }
}

Journal open_journal(const RunOptions& options, const RunIdentity& identity,
                     std::set<std::string>& done, RunTally& tally) {
  const std::filesystem::path file = options.out / "cells.jsonl";
  if (!options.resume || !std::filesystem::exists(file)) return Journal::create(file, identity);
  const JournalContents contents = read_journal(file);
  const std::string difference = contents.identity.difference(identity);
  if (!difference.empty()) {
    throw_bad_input(fmt::format("this folder holds another run:\n{}", difference),
                    options.out.string(), "give another --out, or the same grid, code and data");
  }
  for (const CellResult& result : contents.results) {
    done.insert(result.record.cell);
    if (!is_ok(result.record)) ++tally.failed;
  }
  tally.journal_damage = contents.damage;
  return Journal::resume(file, contents);
}

}  // namespace

std::string data_identity(const Grid& grid, const std::string& data) {
  const Catalogue catalogue = full_catalogue_of(data, grid.own);
  std::uint64_t hash = 0;
  std::set<std::string> inputs;
  for (const std::string& name : grid.problems) {
    const Problem problem = catalogue.find(name).make(grid.first_seed);
    for (const Input& input : problem.inputs) inputs.insert(input.name);
    for (const Stage& stage : problem.stages) hash_table(stage.train, hash);
    hash_table(problem.test, hash);
  }
  require_known_inputs(grid.prior, {inputs.begin(), inputs.end()});
  return fmt::format("{:016x}", hash);
}

RunTally run_grid(const Grid& grid, const RunOptions& options, const RunIdentity& identity,
                  const std::atomic<bool>& stop) {
  const Clock::time_point start = Clock::now();
  make_output_folder(options.out);
  RunTally tally;
  std::set<std::string> done;
  Journal journal = open_journal(options, identity, done, tally);
  write_plan_files(options.out, grid);
  std::vector<PlannedWork> work = plan_work(grid, options.shard, options.costs);
  if (!options.only.empty()) {
    std::erase_if(work,
                  [&](const PlannedWork& item) { return !options.only.contains(item.cell.key()); });
  }
  tally.cells = work.size();
  std::erase_if(work, [&](const PlannedWork& item) { return done.contains(item.cell.key()); });
  tally.found = tally.cells - work.size();
  GridRun(grid, options, journal, tally, stop).run(work);
  tally.stopped = stop.load();
  tally.wall_s = seconds_since(start);
  return tally;
}

}  // namespace tribench
