// SPDX-License-Identifier: MIT
//
// Medians and quantiles. NaN policy: NaN values are left out; where nothing is left the answer is
// NaN. Infinite values count (a formula that diverges is worse than any finite one).
#pragma once

#include <span>
#include <vector>

namespace tribench {

// Quantile by linear interpolation between order statistics (Hyndman, Fan 1996, type 7, the
// default of R and NumPy); level in [0, 1].
double quantile(std::span<const double> values, double level);
inline double median(std::span<const double> values) { return quantile(values, 0.5); }

// The order statistic n / 2, counted from 0: of an even count the upper of the two in the middle,
// so always one of the values. Linear time. No NaN allowed; 0 where there are none.
double upper_median(std::vector<double> values);
// The same of the magnitudes; times kMadToSd a robust estimate of a normal law's standard
// deviation.
double upper_median_magnitude(std::vector<double> values);
inline constexpr double kMadToSd = 1.4826;  // 1 / (the normal law's upper quartile)

struct Spread {
  std::size_t count = 0;  // values that are not NaN
  double low = 0;         // smallest
  double first_quartile = 0;
  double middle = 0;  // median
  double third_quartile = 0;
  double high = 0;  // largest
};
Spread spread_of(std::span<const double> values);

// Ranks 1 .. n in the order of increasing value, ties share their mean rank. No NaN allowed.
std::vector<double> ranks_of(std::span<const double> values);

}  // namespace tribench
