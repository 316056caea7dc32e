// SPDX-License-Identifier: MIT
//
// What a formula's errors on a problem are held against: properties of the problem and its seed
// alone, the same for every method. Nothing here reaches a method.
#pragma once

#include "problems/problem.hpp"
#include "reports/record/record.hpp"

namespace tribench {

// Mean absolute errors on the test rows, in the target's unit; missing where the problem does not
// know the truth or a law for each of its stages.
struct Yardsticks {
  double ceiling = kMissing;  // of the noise-free target: the noise ceiling
  double law = kMissing;      // of the true law with its true constants
  // Of the true law with its constants fitted to the training rows, stage by stage, by least
  // squares: the best that can be expected of data like these, and of a staged problem the best
  // possible with the inputs that each stage is permitted.
  double refitted = kMissing;
  double truth_refitted = kMissing;  // of that law against the noise-free target
};

// Costs a fit of about ten constants a stage: some milliseconds at thousands of rows.
Yardsticks measure_yardsticks(const Problem& problem);

}  // namespace tribench
