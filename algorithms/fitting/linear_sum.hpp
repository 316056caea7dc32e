// SPDX-License-Identifier: MIT
//
// The plainest model that has something to say: a sum of few inputs, or the mean. Inputs are taken
// by forward selection, and how many by folds in which the selection is made anew, so that its
// held-out error is honest: what any other formula on few rows has to beat.
//
// Source: forward stepwise selection, Hastie, Tibshirani & Friedman 2009, sections 3.3 and 7.10.2.
#pragma once

#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

struct LinearSum {
  Expression formula;
  double held_out = 0;  // mean square on rows that neither chose nor fitted it
};

// All values finite; movement[r] names the movement of row r, or is empty: each row is its own. At
// least 8 rows. Cost: 11 selections of at most 20 inputs, some ms for 400 rows and 50 inputs.
LinearSum fit_linear_sum(const Inputs& inputs, std::span<const double> target,
                         std::span<const int> movement);

}  // namespace tribench
