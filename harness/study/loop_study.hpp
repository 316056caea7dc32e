// SPDX-License-Identifier: MIT
//
// How often the closed loop is right: the test matrix of planted effects, run many times with the
// truth known, and the naive tests on the same data for comparison.
//
// Source: the specification of the closed loop, sections 6.1 to 6.3. Planted signs are random, so
// the physical vetoes are off; the gear ratio is given.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tribench {

struct LoopStudyOptions {
  int null_runs = 200;     // ordinary noise; a fifth as many with hard noise and with A only
  int runs_per_cell = 10;  // of each effect at each size
  std::uint64_t first_seed = 1;
  int threads = 0;  // 0: all; the figures are the same for any number
};

// A rate with its Wilson interval, or a mean (trials 0).
struct LoopFigure {
  std::string name;
  std::size_t hits = 0;
  std::size_t trials = 0;
  double value = 0;
  double low = 0;
  double high = 0;
  std::string target;  // as the specification words it
  bool met = true;     // the value itself against the target
};

std::vector<LoopFigure> run_loop_study(const LoopStudyOptions& options);

}  // namespace tribench
