// SPDX-License-Identifier: MIT
//
// The interpreter against plain recursion, at every vector level, in double and in float.
#include "algorithms/expression/evaluate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/agreement.hpp"
#include "tests/algorithms/expression/reference.hpp"

namespace tribench::evaluate_test {
namespace {

constexpr std::size_t kVariables = 3;
const std::vector<std::string> kNames = {"v", "g", "s"};

template <typename T>
struct Table {
  explicit Table(std::size_t rows, std::uint64_t seed = 1) : values(kVariables) {
    RandomStream random(seed);
    for (std::vector<T>& column : values) {
      for (std::size_t r = 0; r < rows; ++r) {
        column.push_back(static_cast<T>(random.uniform(-2, 2)));
      }
      if (rows > 8) {
        column[3] = 0;
        column[5] = std::numeric_limits<T>::infinity();
        column[6] = std::numeric_limits<T>::quiet_NaN();
      }
      pointers.push_back(column.data());
    }
  }
  BasicInputs<T> inputs(std::size_t first = 0, std::size_t count = SIZE_MAX) {
    for (std::size_t j = 0; j < kVariables; ++j) pointers[j] = values[j].data() + first;
    return {pointers, std::min(count, values[0].size() - first)};
  }
  std::vector<T> point(std::size_t row) const {
    std::vector<T> p;
    for (const std::vector<T>& column : values) p.push_back(column[row]);
    return p;
  }
  std::vector<std::vector<T>> values;
  std::vector<const T*> pointers;
};

const RandomFormulas& full_formulas() {
  static const RandomFormulas kFormulas(
      {Op::add, Op::sub, Op::mul, Op::div, Op::pow, Op::neg, Op::exp, Op::log, Op::sqrt, Op::abs,
       Op::sgn, Op::sin, Op::cos, Op::tanh, Op::atan},
      kVariables, {.constant_probability = 0.4, .constant_scale = 2});
  return kFormulas;
}

// Powers with small whole exponents, which random constants never have.
Expression with_whole_exponents(const Expression& formula, RandomStream& random) {
  Expression result = formula;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula.node(i).op != Op::pow || random.chance(0.3)) continue;
    const std::size_t exponent = formula.last_child(i);
    if (formula.node(exponent).is_constant()) {
      set_constant(result, exponent, static_cast<double>(random.below(9)) - 3);
    }
  }
  return result;
}

Expression draw(RandomStream& random, std::size_t largest) {
  const std::size_t size = 1 + random.below(largest);
  const Expression formula = random.chance(0.5) ? full_formulas().grown(size, random)
                                                : full_formulas().balanced(size, random);
  return with_whole_exponents(formula, random);
}

template <typename T>
class Evaluate : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(Evaluate, Scalars);

TYPED_TEST(Evaluate, AgreesBitForBitWithPlainRecursionOnEveryLevel) {
  using T = TypeParam;
  constexpr std::size_t kRows = 21;
  Table<T> table(kRows);
  RandomStream random(key_of("recursion"));
  std::vector<BasicEvaluator<T>> evaluators;
  for (const VectorLevel level : available_vector_levels()) evaluators.emplace_back(level);
  std::vector<T> out(kRows);
  for (int trial = 0; trial < 3000; ++trial) {
    const Expression formula = draw(random, 40);
    for (BasicEvaluator<T>& evaluator : evaluators) {
      evaluator.evaluate(formula, table.inputs(), out);
      for (std::size_t r = 0; r < kRows; ++r) {
        const std::vector<T> point = table.point(r);
        const T expected = reference::evaluate<T>(formula, formula.root(), point);
        ASSERT_TRUE(same(out[r], expected))
            << print(formula, kNames) << " row " << r << ' ' << vector_level_name(evaluator.level())
            << ": " << out[r] << ", not " << expected;
      }
    }
  }
}

TYPED_TEST(Evaluate, DoesNotDependOnHowTheRowsAreSplit) {
  using T = TypeParam;
  constexpr std::size_t kRows = 1111;
  Table<T> table(kRows);
  RandomStream random(key_of("split"));
  BasicEvaluator<T> evaluator;
  std::vector<T> whole(kRows);
  std::vector<T> parts(kRows);
  for (int trial = 0; trial < 200; ++trial) {
    const Expression formula = draw(random, 40);
    evaluator.evaluate(formula, table.inputs(), whole);
    for (std::size_t first = 0; first < kRows;) {
      const std::size_t count = std::min<std::size_t>(1 + random.below(400), kRows - first);
      evaluator.evaluate(formula, table.inputs(first, count),
                         std::span(parts).subspan(first, count));
      first += count;
    }
    for (std::size_t r = 0; r < kRows; ++r) ASSERT_TRUE(same(whole[r], parts[r]));
    for (int k = 0; k < 5; ++k) {
      const std::size_t r = random.below(kRows);
      ASSERT_TRUE(same(evaluator.evaluate_at(formula, table.point(r)), whole[r]));
    }
  }
}

TYPED_TEST(Evaluate, WritesNoRowBeyondTheLast) {
  using T = TypeParam;
  Table<T> table(300);
  BasicEvaluator<T> evaluator;
  const Expression formula = parse("exp(v*g) - s/(v + 2) + abs(g)", kNames);
  for (std::size_t rows = 1; rows < 300; ++rows) {
    std::vector<T> out(rows + 32, T{7});
    evaluator.evaluate(formula, table.inputs(0, rows), std::span(out).first(rows));
    for (std::size_t r = rows; r < out.size(); ++r) ASSERT_EQ(out[r], 7) << rows;
  }
}

TYPED_TEST(Evaluate, TakesLeavesConstantsAndVeryDeepFormulas) {
  using T = TypeParam;
  Table<T> table(3);
  BasicEvaluator<T> evaluator;
  const std::vector<T> point = {T{2}, T{3}, T{-1}};
  EXPECT_EQ(evaluator.evaluate_at(parse("g", kNames), point), 3);
  EXPECT_EQ(evaluator.evaluate_at(parse("2.5", kNames), point), T{2.5});
  EXPECT_EQ(evaluator.evaluate_at(parse("2^3 - 1", kNames), point), 7);
  Expression left = Expression::variable(0);
  Expression right = Expression::variable(0);
  for (int k = 0; k < 5000; ++k) {
    left = Expression::binary(Op::add, left, Expression::variable(2));
    right = Expression::binary(Op::add, Expression::unary(Op::abs, Expression::variable(2)), right);
  }
  EXPECT_EQ(evaluator.evaluate_at(left, point), 2 - 5000);
  EXPECT_EQ(evaluator.evaluate_at(right, point), 2 + 5000);
}

TYPED_TEST(Evaluate, SumsErrorsInOneOrderOnEveryLevel) {
  using T = TypeParam;
  constexpr std::size_t kRows = 1003;
  Table<T> table(kRows);
  table.values[0][5] = table.values[0][6] = 1;
  table.values[1][5] = table.values[1][6] = 1;
  const Expression formula = parse("v*g + 1.5*v - exp(g)/3", kNames);
  std::vector<T> target(kRows);
  std::vector<T> out(kRows);
  RandomStream random(3);
  for (T& y : target) y = static_cast<T>(random.normal());
  std::array<double, 16> sums{};
  BasicEvaluator<T>().evaluate(formula, table.inputs(), out);
  for (std::size_t r = 0; r < kRows; ++r) {
    const auto error = static_cast<double>(out[r] - target[r]);
    sums[r % 16] += error * error;
  }
  for (std::size_t half = 8; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) sums[i] += sums[i + half];
  }
  for (const VectorLevel level : available_vector_levels()) {
    BasicEvaluator<T> evaluator(level);
    const ErrorSum sum = evaluator.sum_squared_errors(formula, table.inputs(), target);
    EXPECT_EQ(sum.sum, sums[0]);
    EXPECT_EQ(sum.rows, kRows);
    EXPECT_EQ(sum.status, ErrorSumStatus::complete);
    const ErrorSum exact = evaluator.sum_squared_errors(formula, table.inputs(), target, sums[0]);
    EXPECT_EQ(exact.status, ErrorSumStatus::complete);
    const ErrorSum early =
        evaluator.sum_squared_errors(formula, table.inputs(), target, 0.1 * sums[0]);
    EXPECT_EQ(early.status, ErrorSumStatus::above_bound);
    EXPECT_GT(early.sum, 0.1 * sums[0]);
    EXPECT_LT(early.rows, kRows);
  }
}

TYPED_TEST(Evaluate, ReportsAnErrorSumThatIsNotFinite) {
  using T = TypeParam;
  Table<T> table(600, 2);
  const std::vector<T> target(600, T{0});
  BasicEvaluator<T> evaluator;
  const ErrorSum sum =
      evaluator.sum_squared_errors(parse("log(v)", kNames), table.inputs(), target);
  EXPECT_EQ(sum.status, ErrorSumStatus::not_finite);
  EXPECT_LT(sum.rows, 600U);
}

}  // namespace
}  // namespace tribench::evaluate_test
