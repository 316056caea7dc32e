// SPDX-License-Identifier: MIT
//
// The regularised upper incomplete gamma function in log space, for tails far below what a
// probability in double precision can hold. With a = n / 2 and x = chi^2 / 2 it is the tail of
// chi-squared with n degrees of freedom.
#pragma once

namespace tribench {

// log Q(a, x) = log( Gamma(a, x) / Gamma(a) ). a > 0; x >= 0 (0 gives 0), infinity gives -infinity.
// Relative error of the logarithm below 1e-10.
// Source: series and Lentz's continued fraction, Abramowitz & Stegun 6.5.29 and 6.5.31.
double log_gamma_upper_tail(double a, double x);

}  // namespace tribench
