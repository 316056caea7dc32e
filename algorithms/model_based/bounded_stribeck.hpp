// SPDX-License-Identifier: MIT
//
// Fits the static friction model under its physical constraints, to global optimality: for given
// (vs, delta) of each branch the rest is linear with Fc >= 0 and Fs - Fc >= 0 and is solved
// exactly, so what remains is a search in two dimensions a branch, done on a grid that is refined
// around its best points; Ipopt polishes all parameters together under the same constraints.
//
// Cost: about 600 evaluations of one exponential a row and branch, independent of the start.
#pragma once

#include "algorithms/budget.hpp"
#include "algorithms/model_based/stribeck_model.hpp"

namespace tribench {

// Fc >= 0, Fs >= Fc, vs between a thousandth of the highest speed and that, 0.5 <= delta <= 4.
BranchRanges physical_ranges(const StribeckRows& rows);

struct StribeckFit {
  double sum_squares = 0;
  bool out_of_budget = false;  // the parameters are the best so far
};

// `model` says which terms there are; its parameters are written. Data are centred on no value and
// need no scaling: in another unit the same parameters are found, to the bit where the units differ
// by a power of two, else to roundoff. At least one row.
StribeckFit fit_bounded_stribeck(const StribeckRows& rows, StribeckModel& model, Budget& budget);

}  // namespace tribench
