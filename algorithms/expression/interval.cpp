// SPDX-License-Identifier: MIT
#include "algorithms/expression/interval.hpp"

#include <array>
#include <bit>
#include <numbers>
#include <utility>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
// Below this an error-free transformation may itself underflow.
constexpr double kSmall = 0x1p-900;

bool is_finite_number(double x) { return std::abs(x) <= kMax; }

// Overflow of finite operands: the exact result lies beyond kMax but is finite.
double overflow_down(double rounded) { return rounded > 0 ? kMax : -kInfinity; }

double two_sum_error(double a, double b, double sum) {
  const double back = sum - a;
  return (a - (sum - back)) + (b - back);
}

// `rounded` is a non-zero exact result of sign `sign`, rounded, close to underflow.
double small_down(double rounded, bool positive) {
  return positive ? std::max(next_down(rounded), 0.0) : next_down(rounded);
}

// y moved outward by the kernels' allowance.
double kernel_down(double y) {
  return y - (std::abs(y) * (kKernelUlps * std::numeric_limits<double>::epsilon()) + kTiny);
}
double kernel_up(double y) { return -kernel_down(-y); }

Decoration least(Decoration a, Decoration b) { return std::min(a, b); }

// Decorates a result: unbounded is at most `continuous`.
DecoratedInterval decorate(const Interval& range, Decoration decoration) {
  if (!range.is_bounded()) decoration = least(decoration, Decoration::continuous);
  return {range, decoration};
}

}  // namespace

double next_up(double x) {
  if (x == 0) return kTiny;
  if (x == kInfinity) return x;
  const auto bits = std::bit_cast<std::int64_t>(x);
  return std::bit_cast<double>(x > 0 ? bits + 1 : bits - 1);
}

double next_down(double x) { return -next_up(-x); }

double add_down(double a, double b) {
  const double sum = a + b;
  if (!is_finite_number(sum)) {
    if (std::isnan(sum)) return -kInfinity;
    return is_finite_number(a) && is_finite_number(b) ? overflow_down(sum) : sum;
  }
  return two_sum_error(a, b, sum) < 0 ? next_down(sum) : sum;
}
double add_up(double a, double b) { return -add_down(-a, -b); }

double mul_down(double a, double b) {
  if (a == 0 || b == 0) return 0;
  const double product = a * b;
  if (!is_finite_number(product)) {
    return is_finite_number(a) && is_finite_number(b) ? overflow_down(product) : product;
  }
  if (std::abs(product) < kSmall) return small_down(product, (a > 0) == (b > 0));
  return std::fma(a, b, -product) < 0 ? next_down(product) : product;
}
double mul_up(double a, double b) { return -mul_down(-a, b); }

double div_down(double a, double b) {
  if (a == 0) return 0;
  const double quotient = a / b;
  if (!is_finite_number(quotient)) {
    if (std::isnan(quotient)) return -kInfinity;
    return is_finite_number(a) ? overflow_down(quotient) : quotient;
  }
  if (std::abs(quotient) < kSmall || std::abs(a) < kSmall) {
    return small_down(quotient, (a > 0) == (b > 0));
  }
  const double remainder = std::fma(-quotient, b, a);
  const bool above = b > 0 ? remainder < 0 : remainder > 0;
  return above ? next_down(quotient) : quotient;
}
double div_up(double a, double b) { return -div_down(-a, b); }

double sqrt_down(double a) {
  const double root = std::sqrt(a);
  if (a == 0 || root == kInfinity) return root;
  if (a < kSmall) return std::max(next_down(root), 0.0);
  return std::fma(-root, root, a) < 0 ? next_down(root) : root;
}
double sqrt_up(double a) {
  const double root = std::sqrt(a);
  if (a == 0 || root == kInfinity) return root;
  if (a < kSmall) return next_up(root);
  return std::fma(-root, root, a) > 0 ? next_up(root) : root;
}

double midpoint(const Interval& x) {
  const double low = std::max(x.low, -kMax);
  const double high = std::min(x.high, kMax);
  const double middle = low / 2 + high / 2;
  if (middle > low && middle < high) return middle;
  const double beside = next_up(low);
  return beside < high ? beside : low;
}

double split_point(const Interval& x) {
  constexpr double kFar = 0x1p40;
  constexpr double kStep = 0x1p-32;
  if (x.low > 0 && x.high / kFar > x.low) return x.high * kStep;
  if (x.high < 0 && x.low / kFar < x.high) return x.low * kStep;
  return midpoint(x);
}

Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval intersect(const Interval& a, const Interval& b) {
  const Interval both{std::max(a.low, b.low), std::min(a.high, b.high)};
  return both.low <= both.high ? both : a;
}

Interval add(const Interval& a, const Interval& b) {
  return {add_down(a.low, b.low), add_up(a.high, b.high)};
}

Interval negate(const Interval& a) { return {-a.high, -a.low}; }

Interval subtract(const Interval& a, const Interval& b) { return add(a, negate(b)); }

Interval multiply(const Interval& a, const Interval& b) {
  if (a.low >= 0) {
    if (b.low >= 0) return {mul_down(a.low, b.low), mul_up(a.high, b.high)};
    if (b.high <= 0) return {mul_down(a.high, b.low), mul_up(a.low, b.high)};
    return {mul_down(a.high, b.low), mul_up(a.high, b.high)};
  }
  if (a.high <= 0) return negate(multiply(negate(a), b));
  if (b.low >= 0 || b.high <= 0) return multiply(b, a);
  return {std::min(mul_down(a.low, b.high), mul_down(a.high, b.low)),
          std::max(mul_up(a.low, b.low), mul_up(a.high, b.high))};
}

Interval divide(const Interval& a, const Interval& b) {
  if (b.high < 0) return divide(negate(a), negate(b));
  if (a.low >= 0) return {div_down(a.low, b.high), div_up(a.high, b.low)};
  if (a.high <= 0) return {div_down(a.low, b.low), div_up(a.high, b.high)};
  return {div_down(a.low, b.low), div_up(a.high, b.low)};
}

namespace {

// x^n for x >= 0 and n >= 1 by repeated squaring. Any other order of the products errs by less
// than n ulp; exact powers stay points. The C library's pow (for |n| > 64 and computed exponents)
// errs by less than an ulp, so what holds the real power between two doubles holds its result.
Interval point_power(double x, int n) {
  Interval result = Interval::point(1);
  Interval square = Interval::point(x);
  for (int rest = n; rest > 0; rest >>= 1) {
    if ((rest & 1) != 0) result = multiply(result, square);
    if (rest > 1) square = multiply(square, square);
  }
  if (result.is_point() || n <= 3) return result;
  const double slack = n * std::numeric_limits<double>::epsilon();
  result.low = std::max(result.low - result.low * slack, 0.0);
  result.high += result.high * slack + kTiny;
  return result;
}

Interval positive_power(const Interval& x, int n) {
  if (n % 2 == 0) {
    return {point_power(x.mignitude(), n).low, point_power(x.magnitude(), n).high};
  }
  const auto odd_low = [n](double t) {
    return t >= 0 ? point_power(t, n).low : -point_power(-t, n).high;
  };
  return {odd_low(x.low), -odd_low(-x.high)};
}

}  // namespace

bool is_integer_power(double exponent) {
  return std::abs(exponent) <= kMaxIntegerPower && exponent == std::floor(exponent);
}

DecoratedInterval integer_power(const DecoratedInterval& x, int n) {
  if (n == 0) return {Interval::point(1), x.decoration};
  const Interval power = positive_power(x.range, std::abs(n));
  if (n > 0) return decorate(power, x.decoration);
  // The evaluator takes 1 / x^|n|: a power that underflows to 0 is a pole in doubles.
  if (power.contains(0)) return {Interval::entire(), Decoration::trivial};
  return decorate(divide(Interval::point(1), power), x.decoration);
}

namespace {

DecoratedInterval divide_decorated(const DecoratedInterval& a, const DecoratedInterval& b) {
  if (b.range.contains(0)) return {Interval::entire(), Decoration::trivial};
  return decorate(divide(a.range, b.range), least(a.decoration, b.decoration));
}

// Real powers of a base >= 0: monotone in each operand, so the extremes are at the corners.
DecoratedInterval real_power(const DecoratedInterval& x, const DecoratedInterval& y) {
  Decoration decoration = least(x.decoration, y.decoration);
  if (x.range.low < 0 || (x.range.low == 0 && y.range.low < 0)) {
    return {Interval::entire(), Decoration::trivial};
  }
  // 0^0 is 1 to the C library: defined, but not continuous.
  if (x.range.low == 0 && y.range.low <= 0) decoration = least(decoration, Decoration::defined);
  const std::array corners = {
      elementary::pow(x.range.low, y.range.low), elementary::pow(x.range.low, y.range.high),
      elementary::pow(x.range.high, y.range.low), elementary::pow(x.range.high, y.range.high)};
  const auto [least_corner, greatest_corner] = std::minmax_element(corners.begin(), corners.end());
  const double low = std::max(kernel_down(std::min(*least_corner, kMax)), 0.0);
  return decorate({low, kernel_up(*greatest_corner)}, decoration);
}

DecoratedInterval power(const DecoratedInterval& x, const DecoratedInterval& y) {
  if (!y.range.is_point()) return real_power(x, y);
  const double exponent = y.range.low;
  if (is_integer_power(exponent)) {
    DecoratedInterval result = integer_power(x, static_cast<int>(exponent));
    result.decoration = least(result.decoration, y.decoration);
    return result;
  }
  return real_power(x, y);
}

DecoratedInterval exponential(const DecoratedInterval& x) {
  const auto bound_low = [](double t) {
    if (t == 0) return 1.0;
    const double y = elementary::exp(t);
    // A kernel may flush results below the normal range to zero.
    if (y < 1e-307) return 0.0;
    const double low = kernel_down(std::min(y, kMax));
    return t > 0 ? std::max(low, 1.0) : low;
  };
  const auto bound_high = [](double t) {
    if (t == 0) return 1.0;
    const double high = kernel_up(elementary::exp(t));
    return t < 0 ? std::min(high, 1.0) : high;
  };
  return decorate({bound_low(x.range.low), bound_high(x.range.high)}, x.decoration);
}

DecoratedInterval logarithm(const DecoratedInterval& x) {
  const auto bound = [](double t, bool is_low) {
    if (t == 1) return 0.0;
    const double y = elementary::log(t);
    const double moved = is_low ? kernel_down(y) : kernel_up(y);
    return t > 1 ? std::max(moved, 0.0) : std::min(moved, 0.0);
  };
  const double high = x.range.high > 0 ? bound(x.range.high, false) : kInfinity;
  if (!(x.range.low > 0)) return {{-kInfinity, high}, Decoration::trivial};
  return decorate({bound(x.range.low, true), high}, x.decoration);
}

DecoratedInterval square_root(const DecoratedInterval& x) {
  if (x.range.high < 0) return {{0, kInfinity}, Decoration::trivial};
  if (x.range.low < 0) return {{0, sqrt_up(x.range.high)}, Decoration::trivial};
  return decorate({sqrt_down(x.range.low), sqrt_up(x.range.high)}, x.decoration);
}

DecoratedInterval sign(const DecoratedInterval& x) {
  const auto of = [](double t) { return t > 0 ? 1.0 : (t < 0 ? -1.0 : 0.0); };
  const Interval range{of(x.range.low), of(x.range.high)};
  return {range, range.is_point() ? x.decoration : least(x.decoration, Decoration::defined)};
}

DecoratedInterval hyperbolic_tangent(const DecoratedInterval& x) {
  const auto low = [](double t) {
    const double moved = std::max(kernel_down(elementary::tanh(t)), -1.0);
    return t >= 0 ? std::max(moved, 0.0) : moved;
  };
  return {{low(x.range.low), -low(-x.range.high)}, x.decoration};
}

DecoratedInterval arc_tangent(const DecoratedInterval& x) {
  constexpr double kQuarterTurn = 0x1.921fb54442d19p+0;  // pi / 2, rounded up
  const auto low = [](double t) {
    const double moved = std::max(kernel_down(elementary::atan(t)), -kQuarterTurn);
    return t >= 0 ? std::max(moved, 0.0) : moved;
  };
  return {{low(x.range.low), -low(-x.range.high)}, x.decoration};
}

// Whether [t - guard] .. [t + guard], in quarter turns, may hold an integer = residue modulo 4.
bool may_hold_turn(double low, double high, int residue) {
  const double first = std::ceil((low - residue) / 4.0);
  return first * 4 + residue <= high;
}

// sin(x + shift * pi/2) on a range of moderate arguments.
Interval sine_range(const Interval& x, int shift) {
  constexpr double kQuarterTurns = 2 / std::numbers::pi;
  // Wider than the rounding of x * 2/pi and than the kernels' error in it.
  const double guard = 1e-12 * (1 + x.magnitude());
  const double low_turn = x.low * kQuarterTurns + shift - guard;
  const double high_turn = x.high * kQuarterTurns + shift + guard;
  const double a = shift == 0 ? elementary::sin(x.low) : elementary::cos(x.low);
  const double b = shift == 0 ? elementary::sin(x.high) : elementary::cos(x.high);
  // Close to a zero of the function a kernel's error is absolute: that of its reduced argument.
  const double slack = 0x1p-58 * (1 + x.magnitude());
  Interval range{kernel_down(std::min(a, b)) - slack, kernel_up(std::max(a, b)) + slack};
  if (may_hold_turn(low_turn, high_turn, 1)) range.high = 1;
  if (may_hold_turn(low_turn, high_turn, 3)) range.low = -1;
  return {std::max(range.low, -1.0), std::min(range.high, 1.0)};
}

constexpr double kMaxReducedArgument = 1e5;

DecoratedInterval sine(const DecoratedInterval& x) {
  if (x.range.magnitude() > kMaxReducedArgument) return {{-1, 1}, x.decoration};
  Interval range = sine_range(x.range, 0);
  if (x.range.low >= 0 && x.range.high < 3.14) range.low = std::max(range.low, 0.0);
  if (x.range.high <= 0 && x.range.low > -3.14) range.high = std::min(range.high, 0.0);
  return {range, x.decoration};
}

DecoratedInterval cosine(const DecoratedInterval& x) {
  if (x.range.magnitude() > kMaxReducedArgument) return {{-1, 1}, x.decoration};
  return {sine_range(x.range, 1), x.decoration};
}

}  // namespace

DecoratedInterval apply(Op op, const DecoratedInterval& a) {
  switch (op) {
    case Op::neg:
      return {negate(a.range), a.decoration};
    case Op::exp:
      return exponential(a);
    case Op::log:
      return logarithm(a);
    case Op::sqrt:
      return square_root(a);
    case Op::abs:
      return {{a.range.mignitude(), a.range.magnitude()}, a.decoration};
    case Op::sgn:
      return sign(a);
    case Op::sin:
      return sine(a);
    case Op::cos:
      return cosine(a);
    case Op::atan:
      return arc_tangent(a);
    default:
      return hyperbolic_tangent(a);
  }
}

DecoratedInterval apply(Op op, const DecoratedInterval& a, const DecoratedInterval& b) {
  const Decoration decoration = least(a.decoration, b.decoration);
  switch (op) {
    case Op::add:
      return decorate(add(a.range, b.range), decoration);
    case Op::sub:
      return decorate(subtract(a.range, b.range), decoration);
    case Op::mul:
      return decorate(multiply(a.range, b.range), decoration);
    case Op::div:
      return divide_decorated(a, b);
    default:
      return power(a, b);
  }
}

}  // namespace tribench
