// SPDX-License-Identifier: MIT
//
// The story of singularities and physics in numbers, from records alone: per operator set and
// method how many formulas divide, how many are proved free, refuted (and how many of those a grid
// of points would have missed) or undecided, of the chosen formulas and of all fronts; how many are
// proved dissipative, monotone and odd; and what division costs or gains in error, raw or admitted
// only where proved free.
//
// A formula divides where a divisor is not a plain number, or a power's exponent is negative.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/run_folder.hpp"
#include "reports/statistics/intervals.hpp"

namespace tribench {

bool divides(std::string_view formula);

// Test error with one operator set over that with another, paired by problem and seed.
struct OperatorPrice {
  std::string method;
  std::string operators;
  std::string against;
  std::size_t pairs = 0;
  double ratio = kMissing;      // median
  ConfidenceInterval interval;  // at 95 %, two-level bootstrap over problems and seeds
  double p = kMissing;          // signed-rank test, Holm-adjusted over all prices
};
// Of every method that ran with two of paper, paper+div and paper+safe_div; a failed cell counts as
// an infinite error.
std::vector<OperatorPrice> operator_prices(const std::vector<Record>& records);

// Markdown, with its heading; empty where no record has a verdict.
std::string proofs_section(const RunFolder& run);

}  // namespace tribench
