// SPDX-License-Identifier: MIT
//
// A movement to be recorded, as a file that people, robots and simulated joints read and write:
// what the loop suggests (next_movements.csv), what a world executes.
//
//   order,kind,velocity_rad_s,from_rad,to_rad,load_factor,duration_s,tone1_rad,tone1_Hz,tone2_rad,tone2_Hz
//   1,constant,0.3,-1.2,0.8,1,6.667,,,,
//   2,two_tone,0.4,-0.5,0.5,1,7.1,0.3,0.21,0.105,0.4
//
// `constant` goes from `from` to `to` at `velocity` (its ramps within the way); `two_tone` is
// q(t) = (from + to) / 2 + sum of amplitude sin(2 pi frequency t) for duration_s.
// Optional columns: rest_s (standing still before it, 0) and other_velocity (peak speed of another
// joint that swings meanwhile, 0). `order`, `separation`, `between` and `why` are for people.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tribench {

struct Tone {
  double amplitude = 0;  // of the position
  double frequency = 0;  // Hz
};

struct PlannedMovement {
  std::string kind;     // "constant" or "two_tone"
  double velocity = 0;  // of the plateau, with its direction; peak of the two-tone movement
  // Position at the start and at the end, in the direction of the velocity; the range of a two-tone
  // movement. NaN where the data have no position.
  double from = 0;
  double to = 0;
  double load_factor = 1;  // on the gravity torque: a payload or another posture
  double duration = 0;     // s; NaN where the data have no position
  std::array<Tone, 2> tones = {};
  double rest = 0;            // s, before it
  double other_velocity = 0;  // peak of the other joint's

  bool is_two_tone() const { return kind == "two_tone"; }
};

// From low to high or back, by the velocity's sign; velocity != 0.
PlannedMovement constant_movement(double velocity, double low, double high, double load_factor);
// Both tones at their fastest at the start, where the speed is `peak` > 0; three periods of the
// first tone.
PlannedMovement two_tone_movement(double peak, double low, double high, double load_factor);

// How the files name units: rad/s is _rad_s.
std::string unit_suffix(std::string_view unit);

// A header and a line a movement; units as in "rad" and "rad/s". `extra`: columns for people, the
// first the names, then a text a movement. rest_s and other_velocity only where one is not 0.
std::string movements_text(const std::vector<PlannedMovement>& movements,
                           std::string_view position_unit, std::string_view velocity_unit,
                           const std::vector<std::string>& extra = {});

// In rad and rad/s. Throws Error (bad_input) with file, line, value and mend: an unknown column or
// kind, a unit that is not rad, a number that is missing or out of its range.
std::vector<PlannedMovement> read_movements(std::string_view text, std::string_view file);

}  // namespace tribench
