// SPDX-License-Identifier: MIT
//
// The tables of the study on simulated campaigns: what was answered to each cause, and false alarms
// and false bursts by kind of noise and design.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "harness/study/loop_figures.hpp"
#include "harness/study/loop_outcome.hpp"

namespace tribench {

// Rates with Wilson intervals against the targets: named (exact, or this cause in another shape) at
// 1 time the noise and more 95 %, confidently wrong 0.5 %, false alarms and false bursts 1 % in
// every kind of noise.
std::vector<LoopFigure> simulated_figures(const std::vector<LoopOutcome>& outcomes);

// How often each answer was given to a cause at one size.
struct CauseAnswers {
  std::string cause;
  double scale = 0;
  std::size_t runs = 0;
  std::array<std::size_t, kSays.size()> counts{};  // in the order of kSays
  double error_ratio = 0;  // held-out error after the refit / the noise; NaN: not judged
};

// In the order in which they come; "none" is what is not planted at all.
std::vector<CauseAnswers> cause_answers(const std::vector<LoopOutcome>& outcomes);

}  // namespace tribench
