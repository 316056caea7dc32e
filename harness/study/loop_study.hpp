// SPDX-License-Identifier: MIT
//
// How often a diagnosis is right: the test matrix of planted effects, run many times with the
// truth known, and the naive tests on the same data for comparison. A bench for the closed loop
// and for anyone's own method (docs/own_diagnosis.md).
//
// Source: the specification of the closed loop, sections 6.1 to 6.3.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/study/loop_figures.hpp"
#include "harness/study/loop_methods.hpp"
#include "harness/study/simulated_figures.hpp"

namespace tribench {

struct LoopStudyOptions {
  LoopGenerator generator = LoopGenerator::planted;
  int null_runs = 200;     // as make_loop_cases and make_simulated_cases have it
  int runs_per_cell = 10;  // of each effect at each size
  std::uint64_t first_seed = 1;
  std::string only;  // cases whose key begins so, as "single/stribeck"; empty: all
  int threads = 0;   // 0: all; the figures are the same for any number
  // Takes runs.csv, a line a run, written as they end. Empty: nothing is written. A folder that
  // has one already is gone on with: what it holds of these runs is not run again.
  std::filesystem::path out;
  bool quiet = true;  // no progress line
};

struct LoopStudy {
  std::vector<LoopOutcome> outcomes;  // in the order of the test matrix
  std::vector<LoopFigure> figures;
  std::vector<CauseAnswers> answers;  // of simulated campaigns
};

// Throws what the method throws, once the runs in progress have ended.
LoopStudy run_loop_study(const LoopStudyOptions& options, const LoopMethod& method);

}  // namespace tribench
