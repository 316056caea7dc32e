// SPDX-License-Identifier: MIT
//
// What the loop's own diagnosis says of the rows that an exploration has recorded, and whether it
// bears out what the weights say: the two err apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/exploration/explanations.hpp"

namespace tribench::loop {

struct NamedFamilies {
  std::vector<std::string> names;  // of the library
  bool unknown = false;            // and something that no library has
};

// Movements that differ by more than the noise of their rows hold something that is not named, as a
// sensor's zero that wanders. Throws what a diagnosis throws.
NamedFamilies diagnosed_families(const Observations& rows, const DiagnosisOptions& options);

// It names as many families as `said`, and the same, and something of no library just where that
// does. Two liberties: what shows where motion changes alone (lag, presliding, inertia) either may
// call by another of its names; and beside a temperature the diagnosis, which knows no sensor that
// is late, may tell what that leaves as something that lives in time.
bool bears_out(const NamedFamilies& diagnosed, const NamedFamilies& said,
               std::span<const ExplainingFamily> families);

}  // namespace tribench::loop
