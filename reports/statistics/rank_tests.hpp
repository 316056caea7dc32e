// SPDX-License-Identifier: MIT
//
// Tests on ranks: what a comparison of methods over problems and seeds rests on. None of them
// assumes a normal distribution. Two-sided throughout.
//
// Sources: Wilcoxon 1945; Pratt, Gibbons 1981 (exact distribution); Holm 1979; Friedman 1937;
// Iman, Davenport 1980; Nemenyi 1963; Demsar 2006, "Statistical comparisons of classifiers over
// multiple data sets" (the worked examples that the tests hold these against).
#pragma once

#include <span>
#include <vector>

namespace tribench {

struct SignedRankTest {
  std::size_t pairs = 0;  // pairs that differ; zero differences are left out (Wilcoxon's rule)
  double rank_sum_positive = 0;
  double rank_sum_negative = 0;
  double p = 1;       // two-sided
  bool exact = true;  // else by the normal approximation with correction for ties
  double effect = 0;  // matched-pairs rank-biserial correlation (Kerby 2014), -1 .. 1
};

// Differences a - b of pairs; infinite differences rank as the largest, NaN pairs are left out.
// Exact over all sign patterns, ties included, up to 60 pairs; O(n^3) there.
SignedRankTest wilcoxon_signed_rank(std::span<const double> differences);

// The smallest p that `pairs` pairs can give: 2 / 2^pairs. Below it nothing can be told.
double smallest_signed_rank_p(std::size_t pairs);

// Holm's step-down adjustment; the answer stands in the order of the input. NaN stays NaN and does
// not count.
std::vector<double> holm(std::span<const double> p_values);

struct FriedmanTest {
  std::size_t blocks = 0;      // rows: problem and seed
  std::size_t treatments = 0;  // columns: methods
  std::vector<double> mean_ranks;
  double chi_squared = 0;
  double p = 1;                    // of chi-squared, corrected for ties
  double critical_difference = 0;  // Nemenyi's, at the level asked for
};

// values[block * treatments + treatment], small is good (rank 1). No NaN allowed.
// level: of Nemenyi's critical difference, e.g. 0.05. With fewer than 2 blocks or treatments p is
// 1 and the critical difference infinite.
FriedmanTest friedman(std::span<const double> values, std::size_t treatments, double level);

// Kendall's tau-b, corrected for ties (Kendall 1945): 1 the same order, -1 the reverse; 1 where
// neither tells two values apart, 0 where only one does. O(n^2).
double kendall_tau(std::span<const double> a, std::span<const double> b);

}  // namespace tribench
