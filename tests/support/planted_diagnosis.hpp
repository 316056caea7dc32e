// SPDX-License-Identifier: MIT
//
// Judged diagnoses of planted campaigns.
#pragma once

#include <cstdint>

#include "harness/loop/judged_diagnosis.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench::testing {

// Signs of planted effects are random: the vetoes, which know which sign is physical, stay out.
inline loop::JudgedDiagnosis diagnose_planted(const kuka::PlantedCase& planted, std::uint64_t seed,
                                              const loop::JudgingOptions& judging = {}) {
  loop::DiagnosisOptions options;
  options.physical_vetoes = false;
  options.gear_ratios = {160};
  const PlantedData run = kuka::make_planted(planted, seed);
  return loop::diagnose_and_judge(loop::observe(run.data), loop::coulomb_viscous_base, options,
                                  judging);
}

}  // namespace tribench::testing
