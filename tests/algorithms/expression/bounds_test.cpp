// SPDX-License-Identifier: MIT
//
// Random formulas over random boxes: bounds contain every sampled value, of every node, computed
// and exact; the derivative's bounds contain difference quotients; and the test would notice.
#include "algorithms/expression/bounds.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/containment.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::bounds_test {
namespace {

using testing::count_escapes;
using testing::random_box;
using testing::sample_box;
using Box = testing::Box;

const std::vector<std::string> kNames = {"v", "g", "t"};

TEST(Bounds, ContainEverySampledValueOfEveryNode) { testing::expect_containment("bounds", 8000); }

// MPFR at 300 bits, node by node: the real value of the formula.
class Exact {
 public:
  explicit Exact(std::size_t nodes) : values_(nodes) {
    for (Number& x : values_) mpfr_init2(&x, 300);
  }
  ~Exact() {
    for (Number& x : values_) mpfr_clear(&x);
  }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;

  void evaluate(const Expression& formula, const std::vector<double>& point) {
    for (std::size_t i = 0; i < formula.size(); ++i) {
      const Node& node = formula.node(i);
      if (node.is_constant()) {
        mpfr_set_d(&values_[i], node.value, MPFR_RNDN);
      } else if (node.is_variable()) {
        mpfr_set_d(&values_[i], point[node.variable], MPFR_RNDN);
      } else if (arity(node.op) == 1) {
        unary(node.op, &values_[i], &values_[i - 1]);
      } else {
        binary(node.op, &values_[i], &values_[formula.left_child(i)], &values_[i - 1]);
      }
    }
  }
  bool is_inside(std::size_t i, const Interval& bounds) {
    return mpfr_cmp_d(&values_[i], bounds.low) >= 0 && mpfr_cmp_d(&values_[i], bounds.high) <= 0;
  }

 private:
  using Number = std::remove_extent_t<mpfr_t>;

  static void unary(Op op, mpfr_ptr y, mpfr_ptr a) {
    switch (op) {
      case Op::neg:
        mpfr_neg(y, a, MPFR_RNDN);
        return;
      case Op::exp:
        mpfr_exp(y, a, MPFR_RNDN);
        return;
      case Op::log:
        mpfr_log(y, a, MPFR_RNDN);
        return;
      case Op::sqrt:
        mpfr_sqrt(y, a, MPFR_RNDN);
        return;
      case Op::abs:
        mpfr_abs(y, a, MPFR_RNDN);
        return;
      case Op::sgn:
        mpfr_set_si(y, mpfr_sgn(a), MPFR_RNDN);
        return;
      case Op::sin:
        mpfr_sin(y, a, MPFR_RNDN);
        return;
      case Op::cos:
        mpfr_cos(y, a, MPFR_RNDN);
        return;
      case Op::atan:
        mpfr_atan(y, a, MPFR_RNDN);
        return;
      default:
        mpfr_tanh(y, a, MPFR_RNDN);
    }
  }
  static void binary(Op op, mpfr_ptr y, mpfr_ptr a, mpfr_ptr b) {
    switch (op) {
      case Op::add:
        mpfr_add(y, a, b, MPFR_RNDN);
        return;
      case Op::sub:
        mpfr_sub(y, a, b, MPFR_RNDN);
        return;
      case Op::mul:
        mpfr_mul(y, a, b, MPFR_RNDN);
        return;
      case Op::div:
        mpfr_div(y, a, b, MPFR_RNDN);
        return;
      default:
        mpfr_pow(y, a, b, MPFR_RNDN);
    }
  }

  std::vector<Number> values_;
};

TEST(Bounds, ContainTheExactValueOfEveryNode) {
  RandomStream random(key_of("bounds exact"));
  for (int trial = 0; trial < 8000; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 2});
    const Box box = random_box(random, 2);
    FormulaBounds bounds(formula);
    const bool all = bounds.sharpen(box);
    const std::size_t known = all ? formula.size() : bounds.failed_node();
    const auto columns = sample_box(random, box);
    Exact exact(formula.size());
    for (std::size_t s = 0; s < 12; ++s) {
      exact.evaluate(formula, {columns[0][s], columns[1][s]});
      for (std::size_t i = 0; i < known; ++i) {
        ASSERT_TRUE(exact.is_inside(i, bounds.at(i).range))
            << print(subtree(formula, i), kNames) << " at " << columns[0][s] << " "
            << columns[1][s];
      }
    }
  }
}

TEST(Bounds, ContainDifferenceQuotients) {
  RandomStream random(key_of("bounds slopes"));
  Evaluator evaluator;
  int compared = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 1});
    const double at = 2 * random.normal();
    const Box box = {{at, at + 0.01}};
    FormulaBounds bounds(formula);
    if (!bounds.sharpen(box) || columns_used(formula) == 0) continue;
    const double rise = evaluator.evaluate_at(formula, std::vector<double>{box[0].high}) -
                        evaluator.evaluate_at(formula, std::vector<double>{box[0].low});
    const double width = box[0].high - box[0].low;
    const double slack = 2 * bounds.rounding_error(formula.root()) + 1e-12 * std::abs(rise);
    const Interval slope = bounds.derivative(formula.root(), 0);
    ASSERT_GE(rise, slope.low * width - slack) << print(formula, kNames);
    ASSERT_LE(rise, slope.high * width + slack) << print(formula, kNames);
    ++compared;
  }
  EXPECT_GT(compared, 8000);
}

// A bound that forgets to round outward must not pass the property test above.
Interval bound_without_rounding(const Expression& formula, const Box& box) {
  std::vector<Interval> values(formula.size());
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_constant()) {
      values[i] = Interval::point(node.value);
    } else if (node.is_variable()) {
      values[i] = box[node.variable];
    } else {
      const Interval& a = values[formula.left_child(i)];
      const Interval& b = values[i - 1];
      values[i] = node.op == Op::add ? Interval{a.low + b.low, a.high + b.high}
                                     : Interval{a.low - b.high, a.high - b.low};
    }
  }
  return values.back();
}

// The mean-value form holds real values only: without the rounding errors of the evaluation it is
// too narrow for what is computed.
Interval mean_value_without_errors(const Box& box) {
  const double centre = midpoint(box[0]);
  const double at_centre = (centre - 1) * (centre - 1);
  const double slope = 2 * std::max(std::abs(box[0].low - 1), std::abs(box[0].high - 1));
  const double reach = slope * (box[0].high - box[0].low) / 2;
  return {at_centre - reach, at_centre + reach};
}

TEST(BoundsTest, NoticesABoundThatIsNotRoundedOutward) {
  RandomStream random(key_of("broken bounds"));
  const Expression formula = parse("v + 0.1 + g - 0.3", kNames);
  Exact exact(formula.size());
  int escapes = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::vector<double> point = {random.normal(), random.normal()};
    const Box box = {Interval::point(point[0]), Interval::point(point[1])};
    exact.evaluate(formula, point);
    escapes += exact.is_inside(formula.root(), bound_without_rounding(formula, box)) ? 0 : 1;
    FormulaBounds sound(formula);
    ASSERT_TRUE(sound.bound(box));
    ASSERT_TRUE(exact.is_inside(formula.root(), sound.root().range));
  }
  EXPECT_GT(escapes, 1000);
}

// (v - r)^2 (v - q) (1 + v/3) expanded: near r it is all cancellation, and what is computed is
// rounding errors of products and sums alike.
Expression expanded_polynomial(RandomStream& random, double root) {
  std::vector<double> coefficients = {1};
  for (const double r : {root, root, random.normal(), -3.0}) {
    coefficients.push_back(0);
    for (std::size_t k = coefficients.size(); k-- > 0;) {
      coefficients[k] = (k > 0 ? coefficients[k - 1] : 0) - r * coefficients[k];
    }
  }
  const Expression v = Expression::variable(0);
  Expression sum = Expression::constant(coefficients[0]);
  for (std::size_t k = 1; k < coefficients.size(); ++k) {
    Expression term = Expression::constant(coefficients[k]);
    for (std::size_t n = 0; n < k; ++n) term = Expression::binary(Op::mul, term, v);
    sum = Expression::binary(Op::add, sum, term);
  }
  return sum;
}

TEST(Bounds, ContainWhatIsComputedWhereAllIsCancellation) {
  RandomStream random(key_of("cancellation"));
  for (int trial = 0; trial < 4000; ++trial) {
    const double root = 3 * random.normal();
    const Expression formula = expanded_polynomial(random, root);
    const double at = root * (1 + 1e-9 * random.normal());
    const double width = std::abs(root) * std::exp2(random.uniform(-48, -28));
    const Box box = {{at, at + width}, {0, 0}, {0, 0}};
    FormulaBounds bounds(formula);
    ASSERT_TRUE(bounds.sharpen(box));
    ASSERT_EQ(count_escapes(formula, sample_box(random, box), bounds.root().range), 0)
        << print(formula, kNames) << " near " << root;
  }
}

TEST(BoundsTest, NoticesAMeanValueFormThatForgetsRoundingErrors) {
  RandomStream random(key_of("broken mean value"));
  const Expression formula = parse("v*v - 2*v + 1", kNames);
  int escapes = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double at = 1 + 1e-9 * random.normal();
    const Box box = {{at, at + 1e-12}, {0, 0}, {0, 0}};
    escapes += count_escapes(formula, sample_box(random, box), mean_value_without_errors(box));
    FormulaBounds sound(formula);
    ASSERT_TRUE(sound.sharpen(box));
    ASSERT_EQ(count_escapes(formula, sample_box(random, box), sound.root().range), 0);
  }
  EXPECT_GT(escapes, 100);
}

}  // namespace
}  // namespace tribench::bounds_test
