// SPDX-License-Identifier: MIT
//
// The observations of a recording (problems/preparation) as the evaluator and the methods see them.
// Not a copy: the columns are those of the observations.
#pragma once

#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "problems/preparation/observations.hpp"

namespace tribench {
struct TrainingData;
}

namespace tribench::loop {

// Pointers to the columns of the signals, for the evaluator. Valid as long as the observations.
class SignalTable {
 public:
  explicit SignalTable(const Observations& data);
  Inputs inputs() const { return {pointers_, rows_}; }

 private:
  std::vector<const double*> pointers_;
  std::size_t rows_;
};

// From a problem's table: the inputs' roles, the target as it stands. Nothing is thrown away but
// rows that are not finite; an input named sgn_X is its own signal.
Observations observe(const TrainingData& data);

}  // namespace tribench::loop
