// SPDX-License-Identifier: MIT
//
// Decorated intervals that bound what our evaluator computes in double precision and, at once, the
// real value of the formula: for every x in X the interval holds f(x) and fl(f)(x). Decorations
// are those of IEEE 1788-2015, section 11: how good the function is on the whole operand, not
// where it happens to exist; log([-1, 2]) is [-inf, log 2] with decoration `trivial`.
//
//   DecoratedInterval v{{-2, 2}};
//   DecoratedInterval d = apply(Op::add, apply(Op::mul, v, v), DecoratedInterval{{1, 1}});
//   apply(Op::div, v, d).decoration;  // common: defined, continuous and bounded
//
// Rounding: operations run in round-to-nearest and are moved outward by an ulp where an error-free
// transformation (two-sum, fused remainder) shows that they were not exact, so exact results stay
// points. exp, log, sin, cos, tanh, atan and pow are foundation/elementary.hpp's, moved outward by
// kKernelUlps: that holds the true value and any evaluator kernel within kKernelUlps - 2 ulp of it
// that also keeps the function's own range and its sign at 0 (for exp and log: at 1). Tests hold
// the evaluator to this. Needs round-to-nearest and IEEE doubles; thread safe; no allocation.
//
// NaN policy: no operand may be NaN; an empty interval cannot be expressed and never arises.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "algorithms/expression/expression.hpp"

namespace tribench {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kKernelUlps = 8;

struct Interval {
  double low = 0;
  double high = 0;

  static constexpr Interval point(double x) { return {x, x}; }
  static constexpr Interval entire() { return {-kInfinity, kInfinity}; }
  bool contains(double x) const { return low <= x && x <= high; }
  bool is_bounded() const { return low > -kInfinity && high < kInfinity; }
  bool is_point() const { return low == high; }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
  // Smallest absolute value.
  double mignitude() const { return contains(0) ? 0 : std::min(std::abs(low), std::abs(high)); }
  bool operator==(const Interval&) const = default;
};

// A double near the middle, inside [low, high], never an end point where there is one between.
double midpoint(const Interval& x);
// Where to halve a range: the middle, or closer to 0 where the ends are of one sign and more than
// 40 binary orders of magnitude apart.
double split_point(const Interval& x);
Interval hull(const Interval& a, const Interval& b);
// The common part; `a` where the two do not meet (which rounding can only bring about by a bug).
Interval intersect(const Interval& a, const Interval& b);

// From worst to best, so that the decoration of a formula is the minimum over its nodes.
enum class Decoration : std::uint8_t {
  trivial,     // undefined somewhere on the operands (IEEE 1788: trv)
  defined,     // defined everywhere, may jump (def)
  continuous,  // defined and continuous everywhere, may overflow (dac)
  common,      // continuous and bounded (com)
};

struct DecoratedInterval {
  Interval range;
  Decoration decoration = Decoration::common;

  // Every value on the operands is a finite double.
  bool is_finite() const { return decoration >= Decoration::defined && range.is_bounded(); }
};

// Directed rounding of single operations on doubles: the largest double <= and the smallest >= the
// exact result, or one ulp beyond where the result is close to underflow. 0 * inf is 0.
double add_down(double a, double b);
double add_up(double a, double b);
double mul_down(double a, double b);
double mul_up(double a, double b);
double div_down(double a, double b);  // b != 0
double div_up(double a, double b);
double sqrt_down(double a);  // a >= 0
double sqrt_up(double a);
double next_down(double x);
double next_up(double x);

// Undecorated arithmetic, for derivatives and bounds of bounds. divide needs 0 outside b.
Interval add(const Interval& a, const Interval& b);
Interval subtract(const Interval& a, const Interval& b);
Interval multiply(const Interval& a, const Interval& b);
Interval divide(const Interval& a, const Interval& b);
Interval negate(const Interval& a);

// x^n for a constant integer exponent, |n| <= kMaxIntegerPower: sharp for even n.
inline constexpr int kMaxIntegerPower = 1024;
DecoratedInterval integer_power(const DecoratedInterval& x, int n);
// Whether an exponent is one that `integer_power` takes.
bool is_integer_power(double exponent);

// One node of a formula. `pow` with a point exponent that is an integer takes integer_power.
DecoratedInterval apply(Op op, const DecoratedInterval& a);
DecoratedInterval apply(Op op, const DecoratedInterval& a, const DecoratedInterval& b);

}  // namespace tribench
