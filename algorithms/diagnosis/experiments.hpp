// SPDX-License-Identifier: MIT
//
// Which movement to record next: the one at which the rival explanations left by a diagnosis
// differ most, in units of the noise, after each has been refitted to what is known.
//
// Source: Atkinson and Fedorov 1975 (T-optimality); specification, section 2.3.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

struct Tone {
  double amplitude = 0;  // of the position
  double frequency = 0;  // Hz
};

struct ProposedMovement {
  std::string kind;     // "constant" or "two_tone"
  double velocity = 0;  // of the plateau, with its direction; peak of the two-tone movement
  // Position at the start and at the end, in the direction of the velocity; the range of a two-tone
  // movement. NaN where the data have no position.
  double from = 0;
  double to = 0;
  double load_factor = 1;  // on the gravity torque: a payload or another posture
  double duration = 0;     // s; NaN where the data have no position
  // Of a two-tone movement: q(t) = (from + to) / 2 + sum of amplitude sin(2 pi frequency t).
  std::array<Tone, 2> tones = {};
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
