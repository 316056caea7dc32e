// SPDX-License-Identifier: MIT
//
// Which movement tells the explanations left apart soonest: how much less its rivals are expected
// to weigh beside the likeliest explanation, a second of motion.
//
// Of a rival that differs from the likeliest by a block of columns the expected gain of a movement
// is what it adds to the block's information, all else refitted (the difference of two Schur
// complements): half the squares that would show at the block's posterior were it there, what the
// block's prior would lose by the log determinant were it not, by how likely either is. The gain of
// a movement is by how many nats the weight of all rivals together falls, so that what is all but
// excluded counts no more.
//
// Source: Atkinson and Fedorov 1975 (T-optimality, rivals refitted); Box and Hill 1967
// (discrimination over a posterior).
#pragma once

#include <string>
#include <vector>

#include "algorithms/exploration/assessment.hpp"

namespace tribench::loop {

struct MovementRows {
  RowRange rows;      // of the foreseen columns
  double counts = 1;  // recorded rows a foreseen row stands for
};

// Movements to choose from as rows: not whitened, as ExplanationSpace has them.
struct Foreseen {
  Eigen::MatrixXd base;
  Eigen::MatrixXd columns;
  std::vector<MovementRows> movements;
};

struct MovementChoice {
  std::size_t movement = 0;
  double gain = 0;      // nats by which the rivals' weight falls
  std::string between;  // the rival that it tells from the likeliest explanation best
};

// Those that tell anything, in the movements' order. disputed: a verdict that somebody else holds,
// empty where nobody does; it is a rival as likely as ours. Cost: rivals x foreseen rows x their
// columns^2, some 20 ms.
std::vector<MovementChoice> movement_gains(const Assessment& now, const Foreseen& foreseen,
                                           const std::string& disputed = {});

}  // namespace tribench::loop
