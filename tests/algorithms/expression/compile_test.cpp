// SPDX-License-Identifier: MIT
//
// Compiled code against the interpreter: the same bits.
#include "algorithms/expression/compile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/agreement.hpp"

namespace tribench::compile_test {
namespace {

constexpr std::size_t kVariables = 12;  // more than there are registers for

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (std::size_t j = 0; j < kVariables; ++j) result.push_back("x" + std::to_string(j));
  return result;
}
const std::vector<std::string> kNames = names();

template <typename T>
struct Table {
  explicit Table(std::size_t rows) {
    RandomStream random(key_of("compile"));
    values.resize(kVariables);
    for (std::vector<T>& column : values) {
      for (std::size_t r = 0; r < rows; ++r) {
        column.push_back(static_cast<T>(random.uniform(-2, 2)));
      }
      if (rows > 9) {
        column[3] = 0;
        column[4] = std::numeric_limits<T>::quiet_NaN();
        column[8] = -std::numeric_limits<T>::infinity();
      }
      pointers.push_back(column.data());
    }
  }
  BasicInputs<T> inputs(std::size_t rows) const { return {pointers, rows}; }
  std::vector<std::vector<T>> values;
  std::vector<const T*> pointers;
};

template <typename T>
std::vector<T> constants_of(const Expression& formula) {
  std::vector<T> constants;
  for (const std::size_t i : constant_positions(formula)) {
    constants.push_back(static_cast<T>(formula.node(i).value));
  }
  return constants;
}

const RandomFormulas kArithmetic({Op::add, Op::sub, Op::mul, Op::div}, kVariables,
                                 {.constant_probability = 0.3});
const RandomFormulas kEverything({Op::add, Op::sub, Op::mul, Op::div, Op::pow, Op::neg, Op::exp,
                                  Op::log, Op::sqrt, Op::abs, Op::sgn, Op::sin, Op::cos, Op::tanh,
                                  Op::atan},
                                 kVariables, {.constant_probability = 0.4});

Expression draw(RandomStream& random) {
  const RandomFormulas& formulas = random.chance(0.3) ? kArithmetic : kEverything;
  const std::size_t size = 1 + random.below(60);
  Expression formula =
      random.chance(0.5) ? formulas.grown(size, random) : formulas.balanced(size, random);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula.node(i).op != Op::pow) continue;
    const std::size_t exponent = formula.last_child(i);
    if (formula.node(exponent).is_constant() && random.chance(0.8)) {
      set_constant(formula, exponent, static_cast<double>(random.below(20)) - 8);
    }
  }
  return formula;
}

std::vector<VectorLevel> levels_that_compile() {
  std::vector<VectorLevel> levels;
  for (const VectorLevel level : available_vector_levels()) {
    if (level != VectorLevel::baseline) levels.push_back(level);
  }
  return levels;
}

template <typename T>
class Compile : public testing::Test {
 protected:
  void SetUp() override {
    if (levels_that_compile().empty()) GTEST_SKIP() << "no code is generated for this processor";
  }
};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(Compile, Scalars);

TYPED_TEST(Compile, GivesTheInterpretersBits) {
  using T = TypeParam;
  const Table<T> table(600);
  RandomStream random(key_of("differential"));
  BasicEvaluator<T> evaluator;
  for (int trial = 0; trial < 1500; ++trial) {
    const Expression formula = draw(random);
    const std::size_t rows = random.chance(0.8) ? 1 + random.below(70) : 200 + random.below(400);
    std::vector<T> expected(rows);
    std::vector<T> out(rows + 8, T{7});
    evaluator.evaluate(formula, table.inputs(rows), expected);
    for (const VectorLevel level : levels_that_compile()) {
      auto code = BasicCompiledFormula<T>::compile(formula, level);
      ASSERT_TRUE(code.has_value());
      code->evaluate(constants_of<T>(formula), table.inputs(rows), std::span(out).first(rows));
      for (std::size_t r = 0; r < rows; ++r) {
        ASSERT_TRUE(same(out[r], expected[r]))
            << print(formula, kNames) << " row " << r << " of " << rows << ' '
            << vector_level_name(level) << ": " << out[r] << ", not " << expected[r];
      }
      for (std::size_t r = rows; r < out.size(); ++r) ASSERT_EQ(out[r], 7);
    }
  }
}

TYPED_TEST(Compile, TakesOtherConstants) {
  using T = TypeParam;
  const Table<T> table(50);
  RandomStream random(key_of("constants"));
  BasicEvaluator<T> evaluator;
  std::vector<T> expected(50);
  std::vector<T> out(50);
  for (int trial = 0; trial < 300; ++trial) {
    Expression formula = draw(random);
    auto code = BasicCompiledFormula<T>::compile(formula);
    if (!code) continue;  // the level in use is pinned to one without code
    const std::vector<std::size_t> positions = constant_positions(formula);
    ASSERT_EQ(code->constants(), positions.size());
    for (int change = 0; change < 3; ++change) {
      for (const std::size_t i : positions) {
        const bool exponent = i < formula.root() && formula.node(i + 1).op == Op::pow;
        if (!exponent) set_constant(formula, i, random.normal());
      }
      evaluator.evaluate(formula, table.inputs(50), expected);
      code->evaluate(constants_of<T>(formula), table.inputs(50), out);
      for (std::size_t r = 0; r < 50; ++r) {
        ASSERT_TRUE(same(out[r], expected[r])) << print(formula, kNames) << " row " << r;
      }
    }
  }
}

TEST(Compile, RefusesTheBaseline) {
  EXPECT_FALSE(
      CompiledFormula::compile(Expression::variable(0), VectorLevel::baseline).has_value());
}

TEST(Compile, TakesVeryDeepFormulas) {
  if (levels_that_compile().empty()) GTEST_SKIP() << "no code is generated for this processor";
  Expression left = Expression::variable(0);
  Expression right = Expression::variable(0);
  for (int k = 0; k < 900; ++k) {
    left = Expression::binary(Op::sub, Expression::variable(1), left);
    right = Expression::binary(Op::mul, Expression::unary(Op::sin, right), Expression::variable(1));
  }
  const Table<double> table(40);
  std::vector<double> expected(40);
  std::vector<double> out(40);
  for (const Expression& formula : {left, right}) {
    auto code = CompiledFormula::compile(formula, levels_that_compile().back());
    ASSERT_TRUE(code.has_value());
    Evaluator().evaluate(formula, table.inputs(40), expected);
    code->evaluate({}, table.inputs(40), out);
    for (std::size_t r = 0; r < 40; ++r) ASSERT_TRUE(same(out[r], expected[r]));
  }
}

TEST(RepeatedEvaluator, CompilesWhenItPaysAndNeverChangesAResult) {
  const Table<double> table(90);
  Expression formula = parse("(x0 + 2)*exp(-0.5*x1^2) - x2/3", kNames);
  const std::vector<std::size_t> positions = constant_positions(formula);
  RepeatedEvaluator repeated;
  repeated.prepare(formula);
  RandomStream random(9);
  std::vector<double> expected(90);
  std::vector<double> out(90);
  Evaluator evaluator;
  for (int turn = 0; turn < 2000; ++turn) {
    std::vector<double> constants;
    for (std::size_t k = 0; k < positions.size(); ++k) constants.push_back(random.normal());
    repeated.set_constants(constants);
    repeated.evaluate(table.inputs(90), out);
    if (turn % 100 != 0) continue;
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const bool exponent = formula.node(positions[k] + 1).op == Op::pow;
      if (!exponent) set_constant(formula, positions[k], constants[k]);
    }
    evaluator.evaluate(formula, table.inputs(90), expected);
    for (std::size_t r = 0; r < 90; ++r) ASSERT_TRUE(same(out[r], expected[r]));
    if (turn == 0) EXPECT_FALSE(repeated.is_compiled());
  }
  EXPECT_EQ(repeated.is_compiled(), vector_level() != VectorLevel::baseline);
}

}  // namespace
}  // namespace tribench::compile_test
