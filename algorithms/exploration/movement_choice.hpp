// SPDX-License-Identifier: MIT
//
// Which movement tells the explanations left apart soonest: the expected gain of evidence against
// every rival of the likeliest explanation, a second of motion.
//
// Of a rival that differs from the likeliest by a block of columns the expected gain of a movement
// is what it adds to the block's information, all else refitted (the difference of two Schur
// complements), at the block's posterior: half the squares that would show were the block there,
// half the log determinant that would fall were it not. It is counted up to what is needed to
// exclude the rival, so that one easy rival does not take all movements.
//
// Source: Atkinson and Fedorov 1975 (T-optimality, rivals refitted); Box and Hill 1967
// (discrimination over a posterior).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "algorithms/exploration/assessment.hpp"

namespace tribench::loop {

struct MovementRows {
  RowRange rows;      // of the foreseen columns
  double cost_s = 0;  // of the movement from where the joint stands
  double counts = 1;  // recorded rows a foreseen row stands for
};

struct MovementChoice {
  std::size_t movement = 0;
  double gain = 0;  // nats, up to what is needed
  double per_second = 0;
  std::string between;  // the rival that it tells from the likeliest explanation best
};

// The best first; empty where no movement tells anything. movements: of the assessment's foreseen
// rows.
std::vector<MovementChoice> rank_movements(const Assessment& now, double alpha,
                                           std::span<const MovementRows> movements);

}  // namespace tribench::loop
