// SPDX-License-Identifier: MIT
//
// Polynomials in one variable that stand in a formula, and their range over an interval: the exact
// one but for rounding and the tolerance below. What beats the dependency problem where a
// polynomial has its extremes inside the interval (x^4 - 2 x^2 + 1.0001).
//
// Method: coefficients in powers, as intervals that hold the real ones; Bernstein coefficients over
// the interval, whose hull holds the range and is the range where the extreme ones stand at the
// ends; else de Casteljau's subdivision, the segment with the extreme coefficient first.
// Source: Cargo, Shisha 1966, "The Bernstein form of a polynomial"; Garloff 1993.
//
// Bounds the real polynomial, not the computed one: rounding errors are the caller's.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"

namespace tribench {

struct Polynomial {
  std::size_t variable = 0;
  std::vector<Interval> coefficients;  // of 1, x, x^2, ...
  std::size_t degree() const { return coefficients.size() - 1; }
};

// The largest subtrees that are polynomials of degree 2 to kMaxPolynomialDegree in one variable
// which occurs in them more than once (where it occurs once, plain intervals are exact), by the
// place of their root; built of constants, + - *, division by a constant and whole powers.
inline constexpr std::size_t kMaxPolynomialDegree = 16;
std::vector<std::optional<Polynomial>> polynomials_of(const Expression& formula);

// Holds the range over x, which must be bounded; wider than it by at most 1e-9 of the largest
// coefficient on the way, or by what 64 subdivisions leave. Cost: O(degree^2), some microseconds.
Interval polynomial_range(std::span<const Interval> coefficients, const Interval& x);

}  // namespace tribench
