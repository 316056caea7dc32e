// SPDX-License-Identifier: MIT
//
// From a file as it was read to a recording that a diagnosis can look at: torque from current,
// velocity and acceleration from position, strokes for movements, rows that say nothing left out,
// undeclared gravity. What was done is said, with the figures; what cannot be true is
// refused with the mend.
//
// A file that has its movements, its velocity and its acceleration comes out as it went in, but for
// rows at a limit of the amplifier and slow ones near a rest or a reversal.
#pragma once

#include <string>
#include <vector>

#include "problems/preparation/data_options.hpp"

namespace tribench {

enum class Gravity {
  automatic,  // fitted where it explains much and no column declares it
  fit,        // sin q and cos q join the base, whatever they explain
  none,       // there is none, or the columns declare it
};

// Slow rows of declared movements, near rests and reversals.
enum class SlowRows {
  left_out,  // they do not count for friction
  kept,      // a recording is wanted as it is
};

struct PreparedRecording {
  Dataset data;
  std::vector<std::string> rigid;  // channels whose coefficients are fitted with the base
  bool derived_velocity = false;   // from the position, in place of a column or of none
  std::size_t unresolved = 0;      // rows left out: the derived motion does not follow there
  std::vector<std::string> notes;  // what was done, one sentence each
};

// Throws Error (bad_input): all that is missing at once, a story that is not possible, two
// quantities of different units where one would have to be subtracted from the other.
PreparedRecording prepare(DataFile file, const DataOptions& options,
                          Gravity gravity = Gravity::automatic, SlowRows slow = SlowRows::left_out);

}  // namespace tribench
