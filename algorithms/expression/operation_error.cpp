// SPDX-License-Identifier: MIT
#include "algorithms/expression/operation_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kUnderflow = std::numeric_limits<double>::denorm_min();
constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr double kKernelError = kKernelUlps * std::numeric_limits<double>::epsilon();
// A kernel of exp may flush results below the normal range to zero.
constexpr double kFlushed = std::numeric_limits<double>::min();

// a * b for bounds of errors: 0 times anything is 0.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

// Whether it is +-2^k, k >= 0, everywhere: a factor that rounds nothing.
bool is_power_of_two(const Interval& x) {
  int exponent = 0;
  const double mantissa = std::frexp(x.low, &exponent);
  return x.is_point() && std::abs(mantissa) == 0.5 && exponent >= 1;
}

double power_error(const Operand& a, const Operand& b, double magnitude) {
  if (b.range.is_point() && is_integer_power(b.range.low) && b.range.low >= 1) {
    const int n = static_cast<int>(b.range.low);
    const Interval largest = Interval::point(a.range.magnitude());
    const double slope = n * integer_power({largest}, n - 1).range.high;
    return times(slope, a.error) + times(b.error, kInfinity);
  }
  double moved = 0;
  if (a.error > 0) moved += b.range.magnitude() * magnitude / a.range.mignitude() * a.error;
  if (b.error > 0) {
    const double logs =
        std::max(std::abs(elementary::log(a.range.low)), std::abs(elementary::log(a.range.high)));
    moved += (logs + 1e-9) * magnitude * b.error;
  }
  return moved;
}

}  // namespace

double operand_error(Op op, const Operand& a, const Interval& result) {
  switch (op) {
    case Op::exp:
      return times(result.magnitude(), a.error);
    case Op::log:
      return a.error / a.range.low;
    case Op::sqrt: {
      const double root = std::sqrt(a.range.low);
      return root > 0 ? std::min(a.error / root, std::sqrt(a.error)) : std::sqrt(a.error);
    }
    case Op::sgn:
      return a.error == 0 || result.is_point() ? 0 : 2;
    default:  // neg, abs, sin, cos, tanh, atan: slopes of at most 1
      return a.error;
  }
}

double operand_error(Op op, const Operand& a, const Operand& b, const Interval& result) {
  switch (op) {
    case Op::add:
    case Op::sub:
      return a.error + b.error;
    case Op::mul:
      return times(a.range.magnitude(), b.error) + times(b.range.magnitude(), a.error);
    case Op::div:
      return (a.error + times(result.magnitude(), b.error)) / b.range.mignitude();
    default:
      return power_error(a, b, result.magnitude());
  }
}

double rounding_error_of(Op op, const Interval& a, const Interval& b, bool same,
                         const Interval& result) {
  const double magnitude = result.magnitude();
  switch (op) {
    case Op::neg:
    case Op::abs:
    case Op::sgn:
      return 0;
    case Op::add:
    case Op::sub:
      return same ? 0 : kRoundoff * magnitude;
    case Op::mul:
      return is_power_of_two(a) || is_power_of_two(b) ? 0 : kRoundoff * magnitude + kUnderflow;
    case Op::div:
    case Op::sqrt:
      return kRoundoff * magnitude + kUnderflow;
    case Op::exp:
      return kKernelError * magnitude + kFlushed;
    case Op::log:
      return kKernelError * magnitude + kUnderflow;
    case Op::pow: {
      const double exponent = std::min(b.magnitude(), 1100.0);
      return (kKernelError + 2 * exponent * kRoundoff) * magnitude + kUnderflow;
    }
    default:  // sin, cos, tanh, atan; the second term is the reduced argument's
      return kKernelError * magnitude + 0x1p-58 * (1 + b.magnitude());
  }
}

}  // namespace tribench
