// SPDX-License-Identifier: MIT
//
// A polynomial through the rows, for its slopes: what a law is symmetric in shows in them long
// before the law is known. Of as high a degree as the rows determine, in the inputs or, where that
// is better on rows held out, in the logarithms of those that are positive.
//
// Not for predictions: between and beyond the rows it says nothing that anyone should use.
#pragma once

#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

class Surrogate {
 public:
  // `target`: finite values on the rows. With more than 12 inputs, fewer than 40 rows, or a budget
  // that does not allow it, there is none, and the error is infinite.
  // Cost: two regressions of at most 140 columns; some 20 ms for 500 rows.
  Surrogate(const LogRows& rows, std::span<const double> target, Budget& budget);

  // Root mean square on every sixth row, which is held out, of the target's own about its mean.
  double error() const { return error_; }
  // Of the target by input j, on the rows.
  const std::vector<double>& slope(std::size_t j) const { return slopes_[j]; }

 private:
  double error_;
  std::vector<std::vector<double>> slopes_;
};

}  // namespace tribench::relay
