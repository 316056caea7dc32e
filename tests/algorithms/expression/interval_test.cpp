// SPDX-License-Identifier: MIT
//
// Interval operators against MPFR and MPFI: the exact range on random operands must lie inside, and
// the bounds must not be wide of it.
#include "algorithms/expression/interval.hpp"

#include <gtest/gtest.h>
#include <mpfi.h>
#include <mpfr.h>

#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/random.hpp"

namespace tribench::interval_test {
namespace {

constexpr int kPrecision = 200;
constexpr std::array kUnary = {Op::neg, Op::exp, Op::log, Op::sqrt, Op::abs,
                               Op::sgn, Op::sin, Op::cos, Op::tanh, Op::atan};
constexpr std::array kBinary = {Op::add, Op::sub, Op::mul, Op::div};

class Mpfi {
 public:
  Mpfi() { mpfi_init2(x_, kPrecision); }
  explicit Mpfi(const Interval& x) : Mpfi() { mpfi_interv_d(x_, x.low, x.high); }
  ~Mpfi() { mpfi_clear(x_); }
  Mpfi(const Mpfi&) = delete;
  Mpfi& operator=(const Mpfi&) = delete;
  mpfi_ptr get() { return x_; }
  // The narrowest doubles around it.
  Interval outer() { return {mpfr_get_d(&x_->left, MPFR_RNDD), mpfr_get_d(&x_->right, MPFR_RNDU)}; }
  // The widest doubles inside it.
  Interval inner() { return {mpfr_get_d(&x_->left, MPFR_RNDU), mpfr_get_d(&x_->right, MPFR_RNDD)}; }

 private:
  mpfi_t x_;
};

void apply_exactly(Op op, mpfi_ptr result, mpfi_ptr a) {
  switch (op) {
    case Op::neg:
      mpfi_neg(result, a);
      return;
    case Op::exp:
      mpfi_exp(result, a);
      return;
    case Op::log:
      mpfi_log(result, a);
      return;
    case Op::sqrt:
      mpfi_sqrt(result, a);
      return;
    case Op::abs:
      mpfi_abs(result, a);
      return;
    case Op::sin:
      mpfi_sin(result, a);
      return;
    case Op::cos:
      mpfi_cos(result, a);
      return;
    case Op::tanh:
      mpfi_tanh(result, a);
      return;
    case Op::atan:
      mpfi_atan(result, a);
      return;
    default:
      mpfi_interv_si(result, mpfr_sgn(&a->left), mpfr_sgn(&a->right));
  }
}

void apply_exactly(Op op, mpfi_ptr result, mpfi_ptr a, mpfi_ptr b) {
  switch (op) {
    case Op::add:
      mpfi_add(result, a, b);
      return;
    case Op::sub:
      mpfi_sub(result, a, b);
      return;
    case Op::mul:
      mpfi_mul(result, a, b);
      return;
    default:
      mpfi_div(result, a, b);
  }
}

// Any sign, magnitudes from underflow to overflow, ordinary ones most often, whole numbers too.
double random_number(RandomStream& random) {
  switch (random.below(6)) {
    case 0:
      return random.sign() * std::exp2(random.uniform(-1070, 1020));
    case 1:
      return static_cast<double>(random.below(9)) - 4;
    case 2:
      return random.uniform(-1e-3, 1e-3);
    case 3:
      return random.uniform(-700, 700);
    default:
      return random.normal();
  }
}

Interval random_interval(RandomStream& random) {
  const double a = random_number(random);
  if (random.chance(0.2)) return Interval::point(a);
  const double b = random.chance(0.3) ? a + 1e-9 * random.normal() : random_number(random);
  return {std::min(a, b), std::max(a, b)};
}

double ulp(double x) {
  return std::max(std::nextafter(std::abs(x), kInfinity) - std::abs(x), 5e-324);
}

// `sharp` ulps of slack on either side: never less than the exact range, never much more.
void expect_encloses(const Interval& bounds, Mpfi& exact, double slack_ulps, double absolute) {
  const Interval inner = exact.inner();
  const Interval outer = exact.outer();
  ASSERT_LE(bounds.low, inner.low);
  ASSERT_GE(bounds.high, inner.high);
  if (std::abs(outer.low) < 1e300) {
    ASSERT_GE(bounds.low, outer.low - slack_ulps * ulp(outer.low) - absolute);
  }
  if (std::abs(outer.high) < 1e300) {
    ASSERT_LE(bounds.high, outer.high + slack_ulps * ulp(outer.high) + absolute);
  }
}

TEST(Interval, ArithmeticEnclosesTheExactRangeWithinAnUlp) {
  RandomStream random(key_of("interval binary"));
  for (int trial = 0; trial < 60000; ++trial) {
    const Op op = kBinary[random.below(kBinary.size())];
    const Interval a = random_interval(random);
    const Interval b = random_interval(random);
    const DecoratedInterval result = apply(op, {a}, {b});
    if (op == Op::div && b.contains(0)) {
      ASSERT_EQ(result.decoration, Decoration::trivial);
      continue;
    }
    Mpfi exact;
    apply_exactly(op, exact.get(), Mpfi(a).get(), Mpfi(b).get());
    SCOPED_TRACE(::testing::Message() << op_name(op) << " [" << a.low << ", " << a.high << "] ["
                                      << b.low << ", " << b.high << "]");
    ASSERT_NO_FATAL_FAILURE(expect_encloses(result.range, exact, 1, 0));
    ASSERT_EQ(result.decoration,
              result.range.is_bounded() ? Decoration::common : Decoration::continuous);
  }
}

bool is_defined(Op op, const Interval& a) {
  if (op == Op::log) return a.low > 0;
  return op != Op::sqrt || a.low >= 0;
}

TEST(Interval, FunctionsEncloseTheExactRangeAndDecorateTheirDomain) {
  RandomStream random(key_of("interval unary"));
  for (int trial = 0; trial < 60000; ++trial) {
    const Op op = kUnary[random.below(kUnary.size())];
    const Interval a = random_interval(random);
    const DecoratedInterval result = apply(op, {a});
    SCOPED_TRACE(::testing::Message() << op_name(op) << " [" << a.low << ", " << a.high << "]");
    ASSERT_EQ(result.decoration > Decoration::trivial, is_defined(op, a));
    if (!is_defined(op, a)) continue;
    const bool is_periodic = op == Op::sin || op == Op::cos;
    if (is_periodic && a.magnitude() > 1e5) {
      ASSERT_EQ(result.range, (Interval{-1, 1}));
      continue;
    }
    Mpfi exact;
    apply_exactly(op, exact.get(), Mpfi(a).get());
    // Kernels get 8 ulp; near an extreme the sine's turn is rounded towards +-1.
    const double absolute =
        is_periodic ? 1e-12 * (1 + a.magnitude()) : (op == Op::exp ? 1e-307 : 0);
    ASSERT_NO_FATAL_FAILURE(expect_encloses(result.range, exact, 2 * kKernelUlps + 2, absolute));
    const bool jumps = op == Op::sgn && !result.range.is_point();
    if (jumps) {
      ASSERT_EQ(result.decoration, Decoration::defined);
    }
  }
}

TEST(Interval, PowersEncloseTheExactValueAtRandomPoints) {
  RandomStream random(key_of("interval power"));
  mpfr_t x;
  mpfr_t y;
  mpfr_inits2(kPrecision, x, y, nullptr);
  int defined = 0;
  for (int trial = 0; trial < 60000; ++trial) {
    const Interval a = random_interval(random);
    const double n = static_cast<double>(random.below(15)) - 7;
    const Interval b = random.chance(0.6) ? Interval::point(random.chance(0.2) ? 17 * n : n)
                                          : Interval{n / 3, n / 3 + random.uniform()};
    const DecoratedInterval result = apply(Op::pow, {a}, {b});
    if (result.decoration == Decoration::trivial) continue;
    ++defined;
    for (int sample = 0; sample < 3; ++sample) {
      const auto inside = [&](const Interval& side) {
        if (random.chance(0.3)) return random.chance(0.5) ? side.low : side.high;
        return std::clamp(side.low + random.uniform() * (side.high - side.low), side.low,
                          side.high);
      };
      mpfr_set_d(x, inside(a), MPFR_RNDN);
      mpfr_set_d(y, inside(b), MPFR_RNDN);
      SCOPED_TRACE(::testing::Message()
                   << mpfr_get_d(x, MPFR_RNDN) << " ^ " << mpfr_get_d(y, MPFR_RNDN));
      mpfr_pow(x, x, y, MPFR_RNDN);
      ASSERT_LE(mpfr_cmp_d(x, result.range.high), 0) << result.range.high;
      ASSERT_GE(mpfr_cmp_d(x, result.range.low), 0) << result.range.low;
    }
  }
  mpfr_clears(x, y, nullptr);
  EXPECT_GT(defined, 20000);
}

TEST(Interval, KnowsTheThinCases) {
  const auto root = [](double low, double high) { return apply(Op::sqrt, {{low, high}}); };
  EXPECT_EQ(root(0, 4).range, (Interval{0, 2}));
  EXPECT_EQ(root(-5e-324, 4).decoration, Decoration::trivial);
  EXPECT_EQ(apply(Op::log, {{0, 1}}).decoration, Decoration::trivial);
  EXPECT_EQ(apply(Op::exp, {{0, 800}}).decoration, Decoration::continuous);
  EXPECT_EQ(apply(Op::exp, {{0, 0}}).range, Interval::point(1));
  EXPECT_EQ(apply(Op::sgn, {{0, 0}}).decoration, Decoration::common);
  EXPECT_EQ(apply(Op::pow, {{-3, 2}}, {{2, 2}}).range, (Interval{0, 9}));
  EXPECT_EQ(apply(Op::pow, {{-3, 2}}, {{-1, -1}}).decoration, Decoration::trivial);
  EXPECT_EQ(apply(Op::pow, {{0, 2}}, {{0, 1}}).decoration, Decoration::defined);
  EXPECT_EQ(apply(Op::add, {{1, 2}}, {{-1, 3}}).range, (Interval{0, 5}));
}

// What the bounds assume of the evaluator's kernels, over each function's whole range.
TEST(Interval, HoldsWhatTheEvaluatorComputesAtEveryPoint) {
  RandomStream random(key_of("interval kernels"));
  std::vector<double> points;
  for (int i = 0; i < 200000; ++i) points.push_back(random_number(random));
  // Around the points where a sign or a range is promised.
  for (int i = 0; i < 20000; ++i) {
    const double small = std::exp2(random.uniform(-1074, 0));
    points.insert(points.end(), {small, -small, 1 + small, 1 - small, 709.78 + small / 100,
                                 -708.4 - 40 * small, M_PI / 2 * (i % 40) + small, 19 + small});
  }
  std::vector<double> values(points.size());
  const double* column = points.data();
  Evaluator evaluator;
  for (const Op op : kUnary) {
    const Expression formula = Expression::unary(op, Expression::variable(0));
    evaluator.evaluate(formula, {{&column, 1}, points.size()}, values);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const DecoratedInterval bounds = apply(op, {Interval::point(points[i])});
      if (bounds.decoration == Decoration::trivial) continue;
      ASSERT_TRUE(bounds.range.contains(values[i]))
          << op_name(op) << "(" << points[i] << ") = " << values[i] << " outside ["
          << bounds.range.low << ", " << bounds.range.high << "]";
    }
  }
}

TEST(Interval, HoldsWhatTheEvaluatorComputesFromTwoOperands) {
  RandomStream random(key_of("interval kernels of two"));
  constexpr std::size_t kPoints = 200000;
  std::vector<double> a(kPoints);
  std::vector<double> b(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    a[i] = random_number(random);
    b[i] = i % 3 == 0 ? static_cast<double>(random.below(13)) - 6 : random_number(random);
  }
  const std::array<const double*, 2> columns = {a.data(), b.data()};
  std::vector<double> values(kPoints);
  Evaluator evaluator;
  for (const Op op : {Op::add, Op::sub, Op::mul, Op::div, Op::pow}) {
    const Expression formula =
        Expression::binary(op, Expression::variable(0), Expression::variable(1));
    evaluator.evaluate(formula, {columns, kPoints}, values);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const DecoratedInterval bounds = apply(op, {Interval::point(a[i])}, {Interval::point(b[i])});
      if (bounds.decoration == Decoration::trivial) continue;
      ASSERT_TRUE(bounds.range.contains(values[i]))
          << a[i] << " " << op_name(op) << " " << b[i] << " = " << values[i] << " outside ["
          << bounds.range.low << ", " << bounds.range.high << "]";
    }
  }
}

}  // namespace
}  // namespace tribench::interval_test
