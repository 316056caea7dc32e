// SPDX-License-Identifier: MIT
//
// What one would do without a thought for movements: tests that take every row for independent.
// Here only to show what that costs; nothing else uses them.
#pragma once

#include "algorithms/loop_model/signal_table.hpp"

namespace tribench {

struct NaiveFindings {
  bool f_test =
      false;         // any family significant: F test of its best atom, Benjamini-Hochberg at 5 %
  bool bic = false;  // any atom that lowers the Bayesian information criterion
};

// Against Coulomb and viscous friction by direction, with the library of the loop.
NaiveFindings test_naively(const loop::Observations& data, double gear_ratio);

}  // namespace tribench
