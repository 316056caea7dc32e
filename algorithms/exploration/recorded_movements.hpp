// SPDX-License-Identifier: MIT
//
// Recordings that are there already, held back and offered as movements: their motion is known, of
// their torque nothing is looked at before a movement is asked for. How few of them say what all of
// them say? Not for a joint that moves as it is asked (explorer.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algorithms/exploration/explanations.hpp"
#include "problems/dataset.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// Movements of more than `longest_s` cut into equal parts, each a movement of its own: a joint can
// be asked for a part of a motion. Distances since reversal and the like are those of the whole.
// longest_s > 0; without a time rows count as seconds.
Observations cut_movements(const Observations& data, double longest_s);
// The same of recorded rows; without a time each row is a second.
Dataset cut_movements(const Dataset& data, double longest_s);

// What rows say: "load_coulomb+stribeck", "NONE". Whose verdict it is does not matter here.
using VerdictOf = std::function<std::string(const Observations&)>;

struct AskedMovement {
  std::size_t movement = 0;  // of data.movements()
  double seconds = 0;
  std::string why;  // what it was to tell apart; "opening", "drawn"
};

struct AskedRecordings {
  // In the order in which they were asked for, up to the first that made the verdict that of all.
  std::vector<AskedMovement> path;
  double seconds() const;
};

// Each time the movement with the most expected evidence a second against the rivals left; at first
// what tells most of Coulomb and viscous friction. gear_ratios as of DiagnosisOptions; `whole`: the
// verdict of all movements. Throws Error (bad_input) where there are fewer than three movements.
// Cost: an assessment and a verdict a movement.
AskedRecordings ask_for_recordings(const Observations& data, const std::vector<double>& gear_ratios,
                                   double alpha, const VerdictOf& verdict,
                                   const std::string& whole);
// In an order drawn from the seed.
AskedRecordings draw_recordings(const Observations& data, const VerdictOf& verdict,
                                const std::string& whole, std::uint64_t seed);

}  // namespace tribench::loop
