// SPDX-License-Identifier: MIT
//
// Which movement to record next: the one at which the rival explanations left by a diagnosis
// differ most, in units of the noise, after each has been refitted to what is known.
//
// Source: Atkinson and Fedorov 1975 (T-optimality); specification, section 2.3.
#pragma once

#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "problems/experiment/planned_movement.hpp"

namespace tribench::loop {

struct ProposedMovement : PlannedMovement {
  double separation = 0;  // mean squared difference of the rivals over the noise variance
  std::string between;    // "stribeck | nonlinear_viscous"
};

// At most `count`, best first, no two alike. Where no rivals are left, the rival is the model
// before the loop: the movement that would confirm the effects best. Empty without effects.
std::vector<ProposedMovement> propose_movements(const Diagnosis& diagnosis,
                                                const Observations& data, std::size_t count);

// A CSV a robot can run, in the order proposed; the columns' names end in the data's units.
std::string movements_csv(const std::vector<ProposedMovement>& movements, const Observations& data);

}  // namespace tribench::loop
