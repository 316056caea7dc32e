// SPDX-License-Identifier: MIT
//
// What a run shows while it runs: on a terminal one line that is written over (counts, rate,
// failures, time left), elsewhere a line now and then.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>

namespace tribench {

// What is counted. Below `from_s` seconds nothing is shown.
struct ProgressUnit {
  const char* name = "cells";
  bool may_fail = true;
  double from_s = 0;
};

class ProgressLine {
 public:
  // predicted_s: what all the cells together are expected to cost; the time left follows from how
  // fast the prediction is worked off.
  ProgressLine(std::size_t cells, double predicted_s, bool quiet, ProgressUnit unit = {});
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Safe from several threads, both.
  void cell_ended(double predicted_s, bool failed);
  void expect_more(std::size_t cells, double predicted_s);

 private:
  void show(bool last);

  std::size_t cells_;
  double predicted_s_;
  bool quiet_;
  ProgressUnit unit_;
  bool is_terminal_;
  std::size_t ended_ = 0;
  std::size_t failed_ = 0;
  double worked_off_s_ = 0;
  double shown_at_s_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
};

}  // namespace tribench
