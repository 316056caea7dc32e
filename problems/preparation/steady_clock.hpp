// SPDX-License-Identifier: MIT
//
// The instants of rows that a steady clock sampled and a jittering one stamped: a bus delivers its
// messages late by turns, a stamp is rounded to whole milliseconds. A position that is read at the
// stamps is then off by velocity times jitter, which is far more than a fine encoder's count.
//
// Whether the rows really are steady the stamps do not tell: the motion does, by being smoother at
// the steady instants (`motion_likelihood`).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "problems/preparation/motion_smoother.hpp"

namespace tribench {

struct SteadyClock {
  std::vector<double> time;  // per row
  double jitter = 0;         // s, root mean square of the stamps about it
};

// In each piece a line through the stamps, rows that are lost among them counted, which may bend
// slowly (a second) as clocks do. Nothing where the stamps are even already or no line comes near
// them. Cost: O(rows).
std::optional<SteadyClock> steady_clock(std::span<const double> time,
                                        std::span<const RowRange> pieces);

}  // namespace tribench
