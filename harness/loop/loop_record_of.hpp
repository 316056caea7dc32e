// SPDX-License-Identifier: MIT
//
// A diagnosis as the record that reports are made of (reports/record/loop_record.hpp).
#pragma once

#include <string>
#include <vector>

#include "algorithms/closed_loop/learned_effect.hpp"
#include "algorithms/exploration/next_movements.hpp"
#include "harness/loop/judged_diagnosis.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {

// What goes beside the diagnosis.
struct LoopExtras {
  std::string title;       // the data's name
  std::uint64_t seed = 0;  // of what was learned: nothing else hangs on one
  std::vector<LearnedEffect> learned;
  std::vector<ProposedMovement> suggestions;
  std::vector<LoopDataStep> steps;  // what became of the rows
  LoopMotion motion;                // loop_motion.hpp
};

// data: what was diagnosed. Cost: a few evaluations of both models on every row.
LoopRecord loop_record_of(const JudgedDiagnosis& diagnosis, const Observations& data,
                          const LoopExtras& extras = {});

}  // namespace tribench::loop
