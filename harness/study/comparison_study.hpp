// SPDX-License-Identifier: MIT
//
// How often `compare` cries without cause, and how often it finds what was planted: made-up runs
// with known differences, 20 seeds on 4 problems and 4 methods.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tribench {

struct ComparisonStudyFigure {
  std::string name;  // "identical code", "one method 3 % worse", ...
  std::size_t trials = 0;
  std::size_t regressions = 0;  // comparisons that cried
  std::size_t right = 0;        // of them, naming exactly the planted method
};

// Errors spread by `seed_spread` (log) over seeds; two runs of identical code differ by
// `run_spread` more, CPU seconds by `time_spread`. A method without randomness has run_spread 0.
struct ComparisonStudyOptions {
  std::size_t comparisons = 200;
  std::size_t seeds = 20;
  double seed_spread = 0.10;
  double run_spread = 0.02;
  double time_spread = 0.03;
};

std::vector<ComparisonStudyFigure> run_comparison_study(const ComparisonStudyOptions& options);

}  // namespace tribench
