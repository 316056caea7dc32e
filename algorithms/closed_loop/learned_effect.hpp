// SPDX-License-Identifier: MIT
//
// How the library grows: where something is left over that no effect explains, a method of
// symbolic regression gets the residual and the inputs in which it lives, on one half of the
// training movements. The formula it finds is a new candidate effect, and is tested by the same
// statistics on the other half, on which it was not found.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::loop {

struct LearnedEffect {
  EffectFamily family;  // "learned:NAME"
  std::string formula;  // over the signals
  double p = 1;         // on the movements it was not found on
  double gain = 0;
  double gain_error = 0;
  bool accepted = false;
  std::size_t found_on = 0;   // movements
  std::size_t tested_on = 0;  // movements
};

// Nothing where nothing is left over or the method gives no formula that varies.
// Deterministic given the seed. Cost: the budget, and one diagnosis.
std::optional<LearnedEffect> learn_effect(const Diagnosis& diagnosis, const Observations& data,
                                          const Regressor& method, const std::string& method_name,
                                          Budget& budget, std::uint64_t seed);

}  // namespace tribench::loop
