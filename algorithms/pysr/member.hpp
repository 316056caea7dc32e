// SPDX-License-Identifier: MIT
//
// A member of a population and the running count of sizes that adaptive parsimony rests on.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

// Only formulas that are finite on every row become members, so loss and cost are finite.
struct Member {
  Expression formula;
  double loss = 0;          // mean squared error, plus the penalty of units
  double cost = 0;          // loss / norm + parsimony * size
  int size = 0;             // complexity by the options' weights
  std::uint64_t birth = 0;  // of its island's own clock: the smallest is the oldest
};

// How often each size has been seen: the frequency f of adaptive parsimony.
// Source: SymbolicRegression.jl, AdaptiveParsimony.jl: counts start at 1, and when their sum
// exceeds the window they are lowered evenly, none below 1.
class SizeFrequencies {
 public:
  explicit SizeFrequencies(int max_size);

  void count(int size);  // sizes outside 1 .. max_size are not counted
  void shrink_to(double window);
  // Brings `normalised` up to date; call after a round of counts.
  void normalise();

  // Share of the size; 0 outside 1 .. max_size.
  double normalised(int size) const;
  const std::vector<double>& counts() const { return counts_; }

 private:
  bool in_range(int size) const { return size >= 1 && size <= static_cast<int>(counts_.size()); }
  std::vector<double> counts_;
  std::vector<double> normalised_;
};

}  // namespace tribench::pysr
