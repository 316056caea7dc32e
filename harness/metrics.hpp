// SPDX-License-Identifier: MIT
//
// The error figures of a formula's values against a target. One definition for every table.
//
// Rows whose target is NaN are left out. A value that is not finite at such a row makes every
// figure missing: a formula that has no value somewhere has no error, and the count says so.
#pragma once

#include <cstddef>
#include <span>

#include "reports/record/record.hpp"

namespace tribench {

struct ErrorFigures {
  double mae = kMissing;        // mean |f - y|
  double rmse = kMissing;       // root of the mean of (f - y)^2
  double max_error = kMissing;  // max |f - y|
  double r2 = kMissing;         // 1 - sum (f - y)^2 / sum (y - mean y)^2; missing if y is constant
  double relative = kMissing;   // 100 |f - y| / |y|, 2-norms, percent; missing if only y is 0
  std::size_t rows = 0;         // with a target
  std::size_t not_finite = 0;   // of these, rows where the formula has no finite value
};

// Sizes must agree. Sums run in the order of the rows.
ErrorFigures compute_errors(std::span<const double> values, std::span<const double> target);

}  // namespace tribench
