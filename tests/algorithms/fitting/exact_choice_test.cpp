// SPDX-License-Identifier: MIT
#include "algorithms/fitting/exact_choice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/elementary.hpp"

namespace tribench::exact_choice_test {
namespace {

const std::vector<std::string> kNames = {"v"};

std::optional<std::size_t> choice_of(const std::vector<std::string>& formulas, double noise = 0) {
  std::vector<double> v;
  std::vector<double> target;
  for (int r = 0; r < 100; ++r) {
    v.push_back(0.03 * r - 1.2);
    target.push_back(2 * v.back() * v.back() + (r % 2 == 0 ? noise : -noise));
  }
  const double* column = v.data();
  std::vector<Expression> parsed;
  for (const std::string& formula : formulas) parsed.push_back(parse(formula, kNames));
  return simplest_exact(parsed, {{&column, 1}, target.size()}, target);
}

TEST(ExactChoice, IsTheShortestFormulaThatIsExactToRounding) {
  EXPECT_EQ(choice_of({"v", "2*v^2", "2*v^2 + 1e-13*v", "2*v^2 + 0*sin(v)"}), 1U);
  // Constants that were polished less do not lose to a longer formula that was polished more.
  EXPECT_EQ(choice_of({"v", "2.0000000001*v^2", "2*v^2 + 0*v"}), 1U);
  EXPECT_EQ(choice_of({"2*v^2 + 0*v", "v*v*2"}), 1U);
}

TEST(ExactChoice, LeavesTheChoiceWhereThereIsNoiseOrTheLawWasNotFound) {
  EXPECT_EQ(choice_of({"v", "2*v^2", "2*v^2 + 1e-3*v"}, 0.01), std::nullopt);
  EXPECT_EQ(choice_of({"v", "1.99*v^2"}), std::nullopt);
  EXPECT_EQ(choice_of({}), std::nullopt);
  EXPECT_EQ(choice_of({"log(v - 9)", "1/0*v"}), std::nullopt);
}

TEST(ExactChoice, DoesNotTakeASimplerFormulaThatIsMerelyGood) {
  EXPECT_EQ(choice_of({"2.00001*v^2", "2*v^2 + 1e-14*v"}), 1U);
}

TEST(ExactChoice, AsksForTheBulkOfTheRowsToo) {
  std::vector<double> v;
  std::vector<double> target;
  for (int r = 0; r < 100; ++r) {
    v.push_back(0.5 * r);
    target.push_back(elementary::exp(v.back()) - 1);
  }
  const double* column = v.data();
  const Inputs rows{{&column, 1}, v.size()};
  const std::vector<Expression> formulas = {parse("exp(v)", kNames),
                                            parse("exp(49.5*exp(20*v - 990))", kNames),
                                            parse("exp(v) - 1", kNames)};
  EXPECT_EQ(simplest_exact({formulas.data(), 2}, rows, target), 0U);
  EXPECT_EQ(simplest_exact({formulas.data() + 1, 1}, rows, target), std::nullopt);
}

TEST(ExactChoice, IsNoFormulaWithAsManyNumbersAsThereAreRows) {
  const std::vector<double> v = {1, 2, 3, 4, 5, 6};
  const double* column = v.data();
  const auto is_exact = [&](const std::string& text, std::size_t rows) {
    const Expression formula = parse(text, kNames);
    const Inputs table{{&column, 1}, rows};
    std::vector<double> target(rows);
    Evaluator().evaluate(formula, table, target);
    return simplest_exact({&formula, 1}, table, target).has_value();
  };
  EXPECT_TRUE(is_exact("2*v^2", 3));
  EXPECT_TRUE(is_exact("2*v^2 + 3", 4));
  EXPECT_FALSE(is_exact("2*v^2 + 3", 2));
  // One row is left over, which is less than the choice of such a form.
  EXPECT_FALSE(is_exact("2*v^2 + 3*v + 4*sin(v) + 5*exp(v)", 6));
  // An exponent that was fitted is a number as well.
  EXPECT_TRUE(is_exact("2*v^2", 2));
  EXPECT_FALSE(is_exact("2*v^2.3", 2));
}

}  // namespace
}  // namespace tribench::exact_choice_test
