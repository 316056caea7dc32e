// SPDX-License-Identifier: MIT
//
// The closed loop as a user gets it: a diagnosis, and what it is worth on movements that it has not
// seen. Not for callers that judge by themselves (a grid) or not at all: diagnose() is for them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/loop_model/bristles.hpp"
#include "harness/loop/loop_judge.hpp"
#include "harness/loop/unused_columns.hpp"

namespace tribench::loop {

struct JudgingOptions {
  double test_share = 0.2;  // of the movements
  bool resample = false;    // search again with movements left out: how sure each effect is
  bool bounds = false;      // bound the noise too: what else could be had (noise_bounds.hpp)
  // The searches without some movements run side by side, with the same answer.
  int threads = 1;
  // Told after each search: how many have ended, of how many; these may become more on the way.
  // Empty: nobody. From any thread, one at a time.
  std::function<void(std::size_t ended, std::size_t searches)> progress;
};

// The movements held out: `share` of them, ascending; none where they are fewer than forty, which
// leaves too few to judge by, or come in groups that are left out together.
std::vector<int> held_out_movements(const Observations& data, double share);

struct JudgedDiagnosis : Diagnosis {
  ErrorFinding error;
  // Of presliding that was found, fitted to the same rows as `after`; empty where there is none.
  std::optional<Bristles> bristles;
  // Columns without a role that explain what is left over; where bounds are asked for.
  std::vector<UnusedColumn> unused_columns;
};

// Judges by held_out_movements. Where there are none, all take part in the verdict and the whole
// procedure is repeated with each movement (a tenth of them where movements and rows are many) left
// out in turn to judge it; a single movement is cut into five pieces for that. Nothing is chosen by
// a movement that judges. Deterministic, whatever the number of threads. Errors: those of
// diagnose().
JudgedDiagnosis diagnose_and_judge(const Observations& data, const BaseMaker& base,
                                   const DiagnosisOptions& options,
                                   const JudgingOptions& judging = {});

}  // namespace tribench::loop
