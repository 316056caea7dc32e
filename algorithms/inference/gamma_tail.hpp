// SPDX-License-Identifier: MIT
//
// The upper tail of a Gamma distribution in log space: the common currency in which candidates
// with different numbers of columns are compared. Scores beyond 15 are ordinary, far below what a
// tail probability in double precision can hold. Not for the shape of a null distribution, which is
// taken to be a Gamma's. A statistic that is NaN says nothing: its score is 0.
#pragma once

#include <cstddef>
#include <vector>

namespace tribench::loop {

// A Gamma distribution matched to the mean and the variance of a statistic under its null
// distribution; score(q) = -log10 P(Q >= q).
class MatchedGamma {
 public:
  // mean > 0, variance > 0; otherwise every score is 0 (a statistic that cannot vary says nothing).
  MatchedGamma(double mean, double variance);

  double score(double statistic) const;  // exact
  // The statistic that has this score; 0 where nothing can vary.
  double statistic_of(double score) const;

  // Prepares a table for statistics up to `largest`, so that thousands of flips cost little.
  void tabulate(double largest);
  // Interpolated in the table, which is filled as it is asked; error below 1e-3; exact beyond it.
  // Monotone in the statistic.
  double fast_score(double statistic);
  // A statistic below which every fast_score is less than this one, the largest in the table; 0
  // without a table.
  double none_below(double score);

 private:
  double shape_ = 0;
  double scale_ = 0;
  double knot(std::size_t k);

  double step_ = 0;  // of the table, in the square root of the statistic
  double inverse_step_ = 0;
  std::vector<double> table_;  // NaN: not asked for yet
};

}  // namespace tribench::loop
