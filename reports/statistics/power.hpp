// SPDX-License-Identifier: MIT
//
// What a comparison that found nothing could have found. Not for planning one before there is data,
// nor for the power to have found what was found: that says no more than the p-value.
#pragma once

#include <span>

namespace tribench {

// The shift that Wilcoxon's signed-rank test at `level` (two-sided) finds in four of five samples
// of as many pairs as these, whose spread they show. From the width of the Hodges-Lehmann interval
// that belongs to the test (Hollander & Wolfe 1999, 3.3): a shift is seen with power 1/2 at half
// the width and with 4/5 at (z(level/2) + z(1/5)) / z(level/2) times that; made 4 % and 0.4/pairs
// larger, since the width is itself drawn (calibrated on normal, uniform and t noise, 8 to 60
// pairs). Infinite and missing differences are left out. Infinity where so few pairs show nothing
// at this level. O(n^2 log n).
double smallest_seen_shift(std::span<const double> differences, double level);

}  // namespace tribench
