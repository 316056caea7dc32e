// SPDX-License-Identifier: MIT
//
// What the columns that nobody gave a role would explain of what a model leaves over: a hint for
// who knows what they are. Not a verdict: a commanded current or a tracking error explains much of
// a torque and is no cause of it.
#pragma once

#include <string>
#include <vector>

#include "harness/loop/loop_judge.hpp"

namespace tribench::loop {

struct UnusedColumn {
  std::string column;
  double share = 0;  // of the mean absolute error, on movements left out
};

// Of data.unused, those of which a smooth function (times 1 and the direction) takes a twentieth or
// more off the residual on movements that it was not fitted to, beyond three standard errors over
// the movements; the largest share first. residual: what the model and smooth functions of the
// other inputs leave (not of the time, where what is left over goes with the time or the movement).
// Cost: five fits of 16 features for each column.
std::vector<UnusedColumn> unused_columns_that_explain(const Observations& data,
                                                      const Eigen::VectorXd& residual,
                                                      const RandomStream& random);

}  // namespace tribench::loop
