// SPDX-License-Identifier: MIT
//
// A diagnosis as JSON with stable keys: the specification's section 5, and beside them the symbols
// of the formula and what the pictures need (reports/loop_report.hpp). Sentences are the report's.
#pragma once

#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/diagnosis/experiments.hpp"
#include "algorithms/diagnosis/learned_effect.hpp"

namespace tribench::loop {

// The formula over the signals' names.
std::string formula_text(const LoopModel& model, const Observations& data);

// What goes beside the diagnosis.
struct LoopExtras {
  std::vector<LearnedEffect> learned;         // key "learned"
  std::vector<ProposedMovement> suggestions;  // key "next_movements"
};

// data: what was diagnosed.
std::string write_loop_json(const Diagnosis& diagnosis, const Observations& data,
                            const LoopExtras& extras = {});

}  // namespace tribench::loop
