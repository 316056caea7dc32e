// SPDX-License-Identifier: MIT
//
// Where a recording hangs together and where it does not: pieces without a gap in time, rows in
// which a bus repeated itself, strokes of motion between rests and reversals, currents at a limit.
// Speeds here are looked at in the units they come in; nothing is changed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/preparation/motion_smoother.hpp"

namespace tribench {

// The step of time that half the rows keep; 0 where there are none.
double median_step(std::span<const double> time, std::span<const int> movement);

// 99 % quantile of the magnitudes.
double top_speed(std::span<const double> velocity);

// Slower than this is at rest: a small part of the top speed, or what the velocity's noise hides.
double rest_speed(std::span<const double> velocity, double noise);

// At least 80 % of the steps are no longer than three and a half medians, and the median is short
// enough (0.1 s) to follow a motion: its derivatives can be taken, lost rows or not.
bool is_regular(std::span<const double> time, std::span<const int> movement);

// Rows of one movement without a gap of more than five steps; `left_out` rows belong to none.
std::vector<RowRange> pieces_of(std::span<const double> time, std::span<const int> movement,
                                std::span<const char> left_out);

// Rows in which a channel that is noisy (`noisy`) repeats its value for five rows and more while
// `position` does so too and moved before and after, by far or on the same way: the bus repeated
// its last message.
std::vector<char> repeated_rows(std::span<const double> position, std::span<const double> noisy,
                                std::span<const int> movement);

// Rows in which a channel that is noisy keeps its value for more than kStuckRows while `position`
// moves on: the sensor, or what reads it, has stopped.
inline constexpr std::size_t kStuckRows = 50;
std::vector<char> stuck_rows(std::span<const double> position, std::span<const double> noisy,
                             std::span<const int> movement);

// Rows at the largest or the smallest value, where far more rows stand on it than on the value next
// to it: the amplifier's limit. All 0 where there is none.
std::vector<char> clipped_rows(std::span<const double> values);

// Motion without a rest: from standstill or a reversal to the next. `noise`: of the velocity.
// Strokes shorter than `fewest` rows are none.
struct Strokes {
  std::vector<RowRange> strokes;
  std::size_t resting = 0;  // rows at rest
  std::size_t reversals = 0;
  std::size_t rests = 0;
};
Strokes strokes_of(std::span<const double> time, std::span<const double> velocity,
                   std::span<const RowRange> pieces, double noise, std::size_t fewest);

}  // namespace tribench
