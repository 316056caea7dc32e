// SPDX-License-Identifier: MIT
//
// On which rows a model that was fitted to others can be judged at all. Where no movement that it
// was fitted to goes backwards, friction and offset are one, and what the model says of a movement
// backwards is the noise of a few rows near the reversals, magnified: no error of the model.
#pragma once

#include <vector>

#include "algorithms/loop_model/loop_model.hpp"

namespace tribench::loop {

// Per row 1 where the model's prediction is at least as certain as the noise of one row: its
// leverage x' (X'X)^-1 x (Hoaglin and Welsch 1978), X the directions in which the model can move on
// the rows with train[i] != 0, times the rows that the noise lasts, is 1 at most. Rows of a fit
// have p / n of that on average. Cost: one Gram matrix of the model's columns.
std::vector<char> determined_rows(const LoopModel& model, const Observations& data,
                                  const std::vector<char>& train, double correlation_rows);

}  // namespace tribench::loop
