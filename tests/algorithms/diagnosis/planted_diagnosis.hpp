// SPDX-License-Identifier: MIT
//
// Diagnoses of planted campaigns, and the families that they name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "problems/data_problem.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/preparation/test_movements.hpp"

namespace tribench::loop {

// Signs of planted effects are random: the vetoes, which know which sign is physical, stay out.
inline DiagnosisOptions options_of_planted() {
  DiagnosisOptions options;
  options.physical_vetoes = false;
  options.gear_ratios = {160};
  return options;
}

// Of a campaign, a fifth is left to judges: it is not looked at. Of a few movements all are.
inline Diagnosis diagnose_most(const Observations& data, const DiagnosisOptions& options) {
  const bool few = data.movements().size() < 40;
  return diagnose(data, coulomb_viscous_base, options,
                  few ? std::vector<int>() : choose_test_movements(data, 0.2));
}

inline Diagnosis diagnose_planted(const kuka::PlantedCase& planted, std::uint64_t seed) {
  return diagnose_most(observe(kuka::make_planted(planted, seed).data), options_of_planted());
}

inline std::vector<std::string> families(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const EffectFinding& effect : diagnosis.effects) names.push_back(effect.family);
  return names;
}

}  // namespace tribench::loop
