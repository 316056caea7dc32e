// SPDX-License-Identifier: MIT
//
// The plainest model that has something to say: a sum of inputs, or the mean. Which inputs is not
// chosen: on few rows many subsets are as good, and their mean (subset_average.hpp) is better. Its
// held-out error, of folds in which all is done anew, is honest: what any other formula on few
// rows has to beat. Of many inputs those that forward selection takes first.
//
// Source: Hoeting et al. 1999; folds: Hastie, Tibshirani & Friedman 2009, section 7.10.2.
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
// least 8 rows. An input is written where it changes the rows by a tenth of what one fitted number
// costs. Cost: some ms for ten inputs, 50 ms for 15 and more on 400 rows.
LinearSum fit_linear_sum(const Inputs& inputs, std::span<const double> target,
                         std::span<const int> movement);

}  // namespace tribench
