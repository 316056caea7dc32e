// SPDX-License-Identifier: MIT
//
// Is the same found in a robot's raw log as in the same physics told cleanly? Joints run under a
// controller (problems/joint_simulation/controlled_run.hpp); each run is told as a clean table, as
// a raw log with what its engineer knows, and bare, with what its header says; `tribench loop` is
// asked about all three, as a user asks it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/study/log_telling.hpp"
#include "harness/study/loop_outcome.hpp"

namespace tribench {

enum class LogTold { cleanly, told, bare };
inline constexpr std::array kLogTellings = {LogTold::cleanly, LogTold::told, LogTold::bare};
std::string_view log_told_name(LogTold told);

// What `tribench loop` answered.
struct LogStory {
  bool refused = false;
  std::string complaint;  // where refused
  LoopAnswer answer;      // families, aliases, UNKNOWN

  std::string text() const;  // "stribeck + lag", "none", "UNKNOWN"
  bool same_as(const LogStory& other) const;
};

struct LogOutcome {
  std::string name;  // "load/17"
  LogTold told = LogTold::cleanly;
  std::string summary;  // how it was told
  LogStory story;
  Says says = Says::exact;
  bool same = true;     // as the clean table's story
  std::string misread;  // a channel whose size is not the truth's, and by how much; else empty
  std::string text;     // the file, where something is wrong with the story
  std::vector<std::string> options;

  bool first = false;  // what was found first is planted, or nothing is and nothing was found

  bool is_right() const {
    return !story.refused && (says == Says::exact || says == Says::another_shape);
  }
  bool is_confidently_wrong() const {
    return !story.refused && (says == Says::wrong || says == Says::with_more);
  }
};

struct LogStudyOptions {
  int logs = 100;
  std::uint64_t first_seed = 1;
  std::string only;  // names that begin so
  bool raw = true;   // tell the logs raw too, not the clean tables alone
  // Raw logs hold the position alone, of an encoder of 2^bits counts a turn; else each draws its
  // own.
  std::optional<int> encoder_bits = {};
  double scale = 2;     // of what is planted, in standard deviations of the noise
  double seconds = 90;  // of a log
  int threads = 0;      // 0: all; the figures are the same for any number
  bool quiet = true;
  const std::atomic<bool>* stop = nullptr;  // logs that are not told when it is set are left out
};

struct LogFigure {
  LogTold told = LogTold::cleanly;
  std::size_t logs = 0;
  std::size_t read = 0;
  std::size_t right = 0;
  std::size_t first = 0;  // found first what is planted; of those that were not null
  std::size_t same = 0;
  std::size_t misread = 0;
  std::size_t wrong = 0;  // confidently
  std::size_t nulls = 0;
  std::size_t false_alarms = 0;  // of the nulls
};

struct LogStudy {
  std::vector<LogOutcome> outcomes;  // by log, then as in kLogTellings
  std::vector<LogFigure> figures;    // as in kLogTellings
  std::size_t left_out = 0;          // logs, when it was stopped
};

// Reads the log as its engineer tells it and prepares it: the channel that comes out with another
// size than it has, and by how much, as a sentence; empty where all are right. Throws what the
// reader throws.
std::string misread_channel(const simulation::ControlledRun& run, const ToldLog& log);

// The run of a seed: a tenth have nothing to be found, a tenth are of linear axes.
struct LogCase {
  std::string name;  // "load/17"
  simulation::ControlledRunPlan plan;
  std::uint64_t seed = 0;
};
LogCase make_log_case(std::uint64_t seed, double scale, double seconds);

// `program` is asked ("/usr/bin/tribench loop ..."). Cost: about 3 s a log.
LogStudy run_log_study(const std::string& program, const LogStudyOptions& options);

}  // namespace tribench
