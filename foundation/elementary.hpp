// SPDX-License-Identifier: MIT
//
// Elementary functions of one number, with the same bits on every machine: whatever a result
// depends on calls these and not the C library, whose exp, log, pow, sin ... differ in their last
// bits between processors (with and without a fused multiply-add) and between versions. A test
// holds every room to that (tests/architecture/c_library_test.cmake).
//
// exp, log, sin, cos, tanh, atan and pow are the evaluator's kernels: elementary::exp(x) is what
// the formula exp(x) evaluates to. Some 5 ns a call. Not for columns: algorithms/expression has
// kernels.
//
// sqrt, fma, fmod, floor, abs, ldexp and nextafter of the C library are exact by definition and
// stay.
//
// NaN policy: NaN in, NaN out; outside a function's domain NaN, at its poles infinity.
#pragma once

#include <span>

namespace tribench::elementary {

// Within 2 ulp of the true value, pow within 1; special points as IEEE 754 has them.
double exp(double x);
double log(double x);
double sin(double x);
double cos(double x);
double tanh(double x);
double atan(double x);
double pow(double x, double y);

// Of every number of a column, in place: the same bits in a third of the time. Not for formulas,
// whose kernels are in algorithms/expression.
void exp_of_each(std::span<double> x);
void sin_of_each(std::span<double> x);
void cos_of_each(std::span<double> x);
void tanh_of_each(std::span<double> x);
void pow_of_each(std::span<double> x, double y);

// Within 4 ulp, expm1 and atanh within 8.
double log1p(double x);
double expm1(double x);
double atanh(double x);
double log10(double x);  // whole for whole powers of ten
double tan(double x);
double sinh(double x);  // within 4 ulp for |x| > 0.5, absolutely so below
double cosh(double x);

// log Gamma(x) for x > 0, to 1e-14 of max(1, |result|); NaN for x <= 0.
// Source: Stirling's series, Abramowitz & Stegun 6.1.41, from 10 on, recurrence below.
double lgamma(double x);

}  // namespace tribench::elementary
