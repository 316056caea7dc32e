// SPDX-License-Identifier: MIT
//
// The few distribution functions that the tests need. Not for arguments out of the ranges named
// here, which are not checked, nor for tails below 1e-300 (foundation/incomplete_gamma.hpp).
#pragma once

namespace tribench {

// P(Z <= z) and its inverse for the standard normal; p in (0, 1).
double normal_cdf(double z);
double normal_quantile(double p);

// P(X > x) for chi-squared with `degrees` degrees of freedom; x >= 0, degrees > 0.
double chi_squared_tail(double x, double degrees);

// P(range of k independent standard normals <= q): the studentized range with infinitely many
// degrees of freedom, by sums at even steps (absolute error below 1e-9 for k <= 100), and its
// inverse, which takes 10 000 values of normal_cdf: 10 ms.
double normal_range_cdf(double q, int k);
double normal_range_quantile(double p, int k);

}  // namespace tribench
