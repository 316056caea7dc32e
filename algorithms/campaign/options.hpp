// SPDX-License-Identifier: MIT
//
// What a diagnosis is asked: levels, families, rules.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/effects/effect_library.hpp"

namespace tribench::loop {

struct DiagnosisOptions {
  double alpha_library = 0.003;
  double alpha_leftover = 0.002;
  std::size_t flips = 1999;
  // The paper's own raw data hold seven at once: both branches, their curvature, three terms of the
  // load and two ripples.
  std::size_t max_effects = 8;
  // Empty: the usual ratios are scanned, and the scan is paid for in the statistics.
  std::vector<double> gear_ratios;
  bool physical_vetoes = true;
  std::vector<EffectFamily> learned;  // families beside the built-in ones
  std::vector<std::string> families;  // to be tested; empty: all
  std::vector<std::string> unnamed;   // looked for like others, but taken out in the end
  std::vector<std::string> without;   // rules left out, to see what they are worth (rules.hpp)
  // Whether the answer says which families look alike in these data (alias_map, aliased): not for
  // searches of which only the effects are asked.
  bool compares_families = true;
  bool has(std::string_view rule) const { return std::ranges::count(without, rule) == 0; }
};

// Throws bad input where so few flips cannot reach a level that is asked for: the smallest p of n
// flips is 1 / (n + 1), and above the level nothing would ever be found.
void require_enough_flips(const DiagnosisOptions& options);

}  // namespace tribench::loop
