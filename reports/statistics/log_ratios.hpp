// SPDX-License-Identifier: MIT
//
// Two methods, or two states of one, on the same seeds: the logarithms of the ratios of their
// figures, as paired tests ask for them.
#pragma once

#include <utility>
#include <vector>

namespace tribench {

class LogRatios {
 public:
  // Not where one is NaN (there is no figure) or both are infinite (both failed).
  static bool is_pair(double reference, double figure);
  // log(figure / reference): 0 for equal ones, infinite where one is 0 or infinite. What is no pair
  // is left out.
  void add(double reference, double figure);
  void shift(double by);

  const std::vector<double>& all() const { return all_; }
  // For tests: figures that repeat to the last digit are one draw, whatever their seeds, as those
  // of a method without chance on one split of one file. Equal figures are no evidence for a
  // difference however often they come, and stay.
  std::vector<double> distinct() const;

 private:
  std::vector<std::pair<double, double>> figures_;
  std::vector<double> all_;
};

}  // namespace tribench
