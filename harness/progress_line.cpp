// SPDX-License-Identifier: MIT
#include "harness/progress_line.hpp"
#include "foundation/standard_streams.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace tribench {
namespace {

std::string duration_text(double seconds) {
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

ProgressLine::ProgressLine(std::size_t cells, double predicted_s, bool quiet, ProgressUnit unit)
    : cells_(cells),
      predicted_s_(predicted_s),
      quiet_(quiet),
      unit_(unit),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() { show(true); }

void ProgressLine::cell_ended(double predicted_s, bool failed) {
  const std::lock_guard lock(mutex_);
  ++ended_;
  worked_off_s_ += predicted_s;
  if (failed) ++failed_;
  show(false);
}

void ProgressLine::expect_more(std::size_t cells, double predicted_s) {
  const std::lock_guard lock(mutex_);
  cells_ += cells;
  predicted_s_ += predicted_s;
}

void ProgressLine::show(bool last) {
  if (quiet_ || cells_ == 0) return;
  const double elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double interval_s = is_terminal_ ? 0.2 : 30.0;
  if (elapsed_s < unit_.from_s) return;
  if (!last && elapsed_s - shown_at_s_ < interval_s) return;
  shown_at_s_ = elapsed_s;
  std::string line =
      fmt::format("{}/{} {}, {:.1f} {}/s, ", ended_, cells_, unit_.name,
                  static_cast<double>(ended_) / std::max(elapsed_s, 1e-3), unit_.name);
  if (unit_.may_fail) line += fmt::format("{} failed, ", failed_);
  line += duration_text(elapsed_s) + " elapsed";
  if (!last && worked_off_s_ > 0) {
    line += fmt::format(", {} left",
                        duration_text(elapsed_s * (predicted_s_ - worked_off_s_) / worked_off_s_));
  }
  if (is_terminal_) {
    print_message(fmt::format("\r\033[K{}{}", line, last ? "\n" : ""));
  } else {
    print_message(fmt::format("{}\n", line));
  }
  std::fflush(stderr);
}

}  // namespace tribench
