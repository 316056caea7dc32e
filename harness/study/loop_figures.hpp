// SPDX-License-Identifier: MIT
//
// The table of the study of the closed loop: rates over many outcomes with their intervals, beside
// the targets of the specification's section 6.3.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/study/loop_outcome.hpp"

namespace tribench {

// A rate in per cent with its Wilson interval, or a mean (trials 0).
struct LoopFigure {
  std::string name;
  std::size_t hits = 0;
  std::size_t trials = 0;
  double value = 0;
  double low = 0;
  double high = 0;
  std::string target;  // as the specification words it; empty: shown for comparison
  bool met = true;     // the value itself against the target
};

std::vector<LoopFigure> loop_figures(const std::vector<LoopOutcome>& outcomes);

}  // namespace tribench
