// SPDX-License-Identifier: MIT
//
// Plans that do not look at what was recorded: what exploration is compared with.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "algorithms/exploration/explorer.hpp"

namespace tribench::loop {

// random: kind, speed (evenly on a logarithmic scale), range, load, rest and the other joint drawn
// within the limits; sweep: constant speeds over the whole range, there and back, slow to fast, at
// every load; sines: single tones at rising speeds and ranges; d_optimal: of the candidates the one
// that most raises the determinant of Coulomb and viscous friction's information, a second.
struct NamedPlan {
  std::string_view name;
  std::string_view summary;
  MovementPlan (*make)(std::uint64_t seed);
};
// informative first. Throws nothing; the seed is used where something is drawn.
const std::vector<NamedPlan>& movement_plans();
// Throws Error (bad_input) with the nearest name.
const NamedPlan& find_plan(std::string_view name);

}  // namespace tribench::loop
