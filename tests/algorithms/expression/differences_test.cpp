// SPDX-License-Identifier: MIT
#include "algorithms/expression/differences.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench::differences_test {
namespace {

const std::vector<std::string> kNames = {"x", "y"};

std::string written(const std::string& formula) {
  return print(with_differences(parse(formula, kNames)), kNames);
}

TEST(Differences, StandWhereNegativeNumbersWereAdded) {
  EXPECT_EQ(written("x + -1"), "x - 1");
  EXPECT_EQ(written("170 + -3*tanh(1.5 + -0.2*x)"), "170 - 3*tanh(1.5 - 0.2*x)");
  EXPECT_EQ(written("-2*x + y"), "y - 2*x");
  EXPECT_EQ(written("y + x/-2"), "y - x/2");
  EXPECT_EQ(written("-2*x + -3"), "-2*x - 3");
}

TEST(Differences, OfNegativeNumbersAreSums) {
  EXPECT_EQ(written("x - -3.85"), "x + 3.85");
  EXPECT_EQ(written("x - -2*y"), "x + 2*y");
}

TEST(Differences, LeaveOtherFormulasAlone) {
  for (const char* formula : {"x + y", "x - y", "-2*x", "x^-2", "exp(-0.5*x)*y + 3", "x*(y - 1)"}) {
    EXPECT_EQ(written(formula), formula);
  }
}

TEST(Differences, HaveTheSameValuesBitForBitAndNotMoreNodes) {
  const RandomFormulas formulas(
      {Op::add, Op::sub, Op::mul, Op::div, Op::neg, Op::exp, Op::tanh, Op::sin}, kNames.size());
  RandomStream random(1);
  const std::vector<double> x = {-3.1, -0.7, 0, 0.4, 1, 12.3};
  const std::vector<double> y = {2.2, -5, 0.01, 0, -1, 7};
  const std::vector<const double*> columns = {x.data(), y.data()};
  int changed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Expression formula = formulas.grown(1 + random.below(24), random);
    const Expression other = with_differences(formula);
    ASSERT_LE(other.size(), formula.size());
    ASSERT_LE(paper_complexity(other), paper_complexity(formula));
    changed += formula == other ? 0 : 1;
    ASSERT_EQ(with_differences(other), other);
    std::vector<double> before(x.size());
    std::vector<double> after(x.size());
    Evaluator().evaluate(formula, {columns, x.size()}, before);
    Evaluator().evaluate(other, {columns, x.size()}, after);
    for (std::size_t r = 0; r < x.size(); ++r) {
      if (std::isnan(before[r]) && std::isnan(after[r])) continue;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(before[r]), std::bit_cast<std::uint64_t>(after[r]))
          << print(formula, kNames);
    }
  }
  EXPECT_GT(changed, 300);
}

}  // namespace
}  // namespace tribench::differences_test
