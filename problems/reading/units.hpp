// SPDX-License-Identifier: MIT
//
// Units as logs name them, and their SI values: "deg/s", "rpm", "mA", "mN m", "degF", "counts".
// Everything beyond the reader is in rad, rad/s, rad/s^2, m, m/s, m/s^2, s, N m, N, A, V, degC.
//
// Not a general unit system: only what a robot's log holds, so that an unknown word is a question
// to the user and never a guess.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "problems/dataset.hpp"

namespace tribench {

enum class Dimension {
  angle,
  angular_velocity,
  angular_acceleration,
  length,
  speed,
  linear_acceleration,
  time,
  torque,
  force,
  current,
  voltage,
  temperature,
  mass,
  share,  // per cent of something rated
};

// The SI value is (value + offset) * factor.
struct Unit {
  std::string_view symbol;  // as printed: "deg/s"
  std::string_view si;      // what it becomes: "rad/s"
  Dimension dimension;
  double factor;
  double offset = 0;
  bool counts = false;  // the factor is of turns: it waits for the counts of one
};

// Any usual spelling: case is looked at only where it decides, blanks and dots between the parts
// never. Null where the word is no unit.
const Unit* find_unit(std::string_view text);

// A unit as a header or a user writes it: "deg", "0.229 rpm" (a number of it, as drives count),
// "counts@motor" (on the motor's side of the gear). No unit: unit is null.
struct WrittenUnit {
  const Unit* unit = nullptr;
  double scale = 1;
  bool at_motor = false;

  std::string symbol() const;  // reads back as the same
};
WrittenUnit find_written_unit(std::string_view text);

// Whether a channel of this role can be measured in the unit; true for a role that says nothing.
bool suits(const Unit& unit, Role role);

// A torque, a force, or what a drive puts in for one.
bool measures_effort(const Unit& unit);

// "rad, deg, rev, counts, m, mm": what `suits` takes, for messages.
std::string units_of(Role role);

// The unit of such a role whose usual spelling is closest to a word that is none; empty: none is.
std::string nearest_unit(std::string_view text, Role role);

// What the user knows of the drive, as far as units need it.
struct Drive {
  std::optional<double> counts_per_turn;
  std::optional<double> gear_ratio;
};

// A channel's values in SI are (value + offset) * factor.
struct Conversion {
  double factor = 1;
  double offset = 0;
  std::string unit;  // SI symbol
};

// The conversion of a unit. Of a quantity on the motor's side of the gear motion is divided, torque
// multiplied by the ratio. `needs` says what the drive lacks for
// it ("--counts-per-turn N"); the conversion is then not to be used.
struct Converted {
  Conversion conversion;
  std::string needs;
};
Converted conversion_of(const WrittenUnit& written, const Drive& drive);

}  // namespace tribench
