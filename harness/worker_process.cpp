// SPDX-License-Identifier: MIT
#include "harness/worker_process.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

constexpr double kTickSeconds = 0.05;
constexpr std::string_view kStarted = "{\"started\":";
constexpr std::string_view kFinished = "{\"finished\":";
constexpr std::string_view kOutOfMemory = "{\"out_of_memory\":";
constexpr std::string_view kEnvironment = "{\"environment\":";

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string_view body_of(std::string_view line, std::string_view prefix) {
  return line.substr(prefix.size(), line.size() - prefix.size() - 1);
}

std::string last_line(std::string_view text) {
  constexpr std::size_t kShown = 200;
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const std::size_t start = text.rfind('\n');
  if (start != std::string_view::npos) text.remove_prefix(start + 1);
  return std::string(text.substr(0, kShown));
}

}  // namespace

// What the worker has said about the cell so far.
struct WorkerProcess::Reading {
  std::string pending;
  std::string errors;
  std::optional<CellResult> started;
  std::optional<CellResult> finished;
  bool out_of_memory = false;

  void take(const ChildOutput& output) {
    errors += output.errors;
    if (errors.size() > 8192) errors.erase(0, errors.size() - 4096);
    pending += output.output;
    for (std::size_t end = pending.find('\n'); end != std::string::npos; end = pending.find('\n')) {
      const std::string_view line = std::string_view(pending).substr(0, end);
      if (line.starts_with(kStarted)) started = parse_result(body_of(line, kStarted));
      if (line.starts_with(kFinished)) finished = parse_result(body_of(line, kFinished));
      if (line.starts_with(kOutOfMemory)) out_of_memory = true;
      if (line.starts_with(kEnvironment)) {
        throw Error(ErrorKind::environment,
                    read_json<nlohmann::json>(body_of(line, kEnvironment)).get<std::string>(), {},
                    "what is done is kept: mend it and go on by --resume");
      }
      pending.erase(0, end + 1);
    }
  }
};

WorkerProcess::WorkerProcess(WorkerOptions options) : options_(std::move(options)) {}

WorkerProcess::~WorkerProcess() { renew(); }

void WorkerProcess::renew() {
  if (!process_) return;
  process_.reset();
  scratch_.reset();  // only once nothing writes there any more
  cells_run_ = 0;
}

void WorkerProcess::ensure_process() {
  if (cells_run_ >= options_.cells_per_worker) renew();
  if (process_) return;
  scratch_.emplace();
  const std::string temporary = "TMPDIR=" + scratch_->path().string();
  process_ = std::make_unique<ChildProcess>(
      ChildOptions{options_.command, {temporary}, {}, scratch_->path()});
  ++started_;
  if (options_.cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(*options_.cpu), &set);
    // Not being allowed to pin costs precision of the times, not results.
    sched_setaffinity(process_->pid(), sizeof set, &set);
  }
}

CellOutcome WorkerProcess::run(const CellTask& task, const std::atomic<bool>& stop) {
  ensure_process();
  bool is_fresh = cells_run_ == 0;
  std::string request = print_task(task) + "\n";
  if (!process_->write(request)) {  // it died between two cells
    renew();
    ensure_process();
    is_fresh = true;
    process_->write(request);
  }
  ++cells_run_;
  CellOutcome outcome = wait_for_answer(task, stop);
  outcome.fresh_worker = is_fresh;
  if (outcome.end != CellEnd::finished) renew();
  return outcome;
}

std::optional<CellEnd> WorkerProcess::exceeded(const CellTask& task, double wall_s,
                                               double cpu_before_s) const {
  if (wall_s > task.limits.wall_seconds) return CellEnd::timeout;
  const ProcessUse use = process_tree_use(process_->pid());
  if (use.cpu_s - cpu_before_s > task.limits.cpu_limit_seconds) return CellEnd::cpu_limit;
  if (use.resident_mib > task.limits.memory_mib) return CellEnd::out_of_memory;
  return std::nullopt;
}

CellEnd WorkerProcess::end_of_process() {
  const ChildExit exit = process_->wait();
  last_end_ =
      exit.signal != 0 ? signal_name(exit.signal) : fmt::format("exit status {}", exit.status);
  return CellEnd::crashed;
}

CellOutcome WorkerProcess::wait_for_answer(const CellTask& task, const std::atomic<bool>& stop) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_before_s = process_tree_use(process_->pid()).cpu_s;
  Reading reading;
  CellOutcome outcome;
  double next_check_s = kTickSeconds;
  while (!reading.finished) {
    if (stop.load(std::memory_order_relaxed)) {
      outcome.end = CellEnd::stopped;
      return outcome;
    }
    const ChildOutput output = process_->read(kTickSeconds);
    reading.take(output);
    if (reading.finished) break;
    if (reading.out_of_memory) {
      outcome.end = CellEnd::out_of_memory;
    } else if (output.ended) {
      outcome.end = end_of_process();
    } else if (seconds_since(start) >= next_check_s) {
      next_check_s = seconds_since(start) + kTickSeconds;
      outcome.end = exceeded(task, seconds_since(start), cpu_before_s).value_or(CellEnd::finished);
    }
    if (outcome.end != CellEnd::finished) {
      finish_failed(task, reading, outcome);
      outcome.result.record.fit_wall_s = seconds_since(start);
      return outcome;
    }
  }
  outcome.result = std::move(*reading.finished);
  return outcome;
}

void WorkerProcess::finish_failed(const CellTask& task, Reading& reading, CellOutcome& outcome) {
  outcome.result.record = reading.started ? reading.started->record : empty_record(task.cell);
  Record& record = outcome.result.record;
  switch (outcome.end) {
    case CellEnd::timeout:
      return mark_failed(record, FailureKind::timeout);
    case CellEnd::cpu_limit:
      return mark_failed(record, FailureKind::cpu_limit);
    case CellEnd::out_of_memory:
      return mark_failed(record, FailureKind::out_of_memory);
    default:
      mark_failed(record, FailureKind::crashed, last_end_);
      record.note = last_line(reading.errors);
  }
}

}  // namespace tribench
