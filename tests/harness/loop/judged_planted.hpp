// SPDX-License-Identifier: MIT
//
// Judged diagnoses of planted campaigns.
#pragma once

#include <cstdint>

#include "harness/loop/judged_diagnosis.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {

inline JudgedDiagnosis judge_planted(const kuka::PlantedCase& planted, std::uint64_t seed,
                                     const JudgingOptions& judging = {}) {
  return diagnose_and_judge(observe(kuka::make_planted(planted, seed).data), coulomb_viscous_base,
                            options_of_planted(), judging);
}

}  // namespace tribench::loop
