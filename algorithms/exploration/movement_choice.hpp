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
  double gain = 0;      // nats, up to what is needed
  std::string between;  // the rival that it tells from the likeliest explanation best
};

// Those that tell anything, in the movements' order. Cost: rivals x foreseen rows x their
// columns^2, some 20 ms.
std::vector<MovementChoice> movement_gains(const Assessment& now, const Foreseen& foreseen,
                                           double alpha);

}  // namespace tribench::loop
