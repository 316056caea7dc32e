// SPDX-License-Identifier: MIT
//
// Which formula of a front the method stands for. Not for fronts of several methods, whose losses
// may be of different rows (fitting/joint_front.hpp).
#pragma once

#include <span>
#include <vector>

#include "algorithms/pysr/options.hpp"

namespace tribench::pysr {

// One formula of a front, which is sorted by increasing size and decreasing loss.
struct FrontPoint {
  double loss = 0;
  int size = 0;
  double evidence_against = 0;    // nats; see fitting/evidence.hpp
  double description_length = 0;  // nats
  double distance = 0;            // mean squared, from the posterior mean
};

// max(0, -(ln loss_i - ln loss_{i-1}) / (size_i - size_{i-1})); 0 for the first. A loss of 0 after
// one above 0 scores infinitely.
std::vector<double> front_scores(std::span<const FrontPoint> front);

// The place of the choice; 0 for an empty front.
//   posterior the least distance from the posterior mean; of several, the smallest formula
//   evidence  the least evidence against it
//   mdl       the smallest description length
//   accuracy  the smallest loss
//   score     the highest score
//   best      the highest score among losses up to 1.5 times the smallest
// Source: PySR, pysr/sr.py, idx_model_selection; posterior, evidence and mdl are ours.
std::size_t select(std::span<const FrontPoint> front, Selection rule);

}  // namespace tribench::pysr
