// SPDX-License-Identifier: MIT
#include "algorithms/relay/function_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"

namespace tribench {
namespace {

using relay::SumTerms;
using testing::DrawnInput;
using testing::DrawnLaw;

const OperatorSet& all_operators() { return find_operator_set("full"); }

struct Law {
  std::string text;
  std::vector<DrawnInput> inputs;
};

std::optional<Expression> found_in(const DrawnLaw& law, SumTerms terms,
                                   const OperatorSet& operators = all_operators()) {
  const FiniteRows finite(law.data());
  Budget budget({});
  const std::vector<Expression> found =
      relay::find_function_sums(relay::LogRows(finite, 300), operators, terms, budget);
  return found.empty() ? std::nullopt : std::optional(found[0]);
}

TEST(FunctionSum, FindsFunctionsWhoseSizesOtherInputsSet) {
  const std::vector<Law> laws = {
      {"fc + (fs - fc)*exp(-(v/vs)^2) + b*v",
       {{"fc", 1, 3}, {"fs", 2, 5}, {"v", 0.05, 3}, {"vs", 0.5, 2}, {"b", 0.2, 1.5}}},
      {"fc*tanh(v/vs) + 0.7*v", {{"fc", 1, 4}, {"v", -3, 3}, {"vs", 0.3, 1.5}}},
      {"a + (b - a)/(1 + 2.6*x)", {{"a", 0, 1}, {"b", 3, 6}, {"x", 0.1, 4}}},
      {"p + (r - p)*sqrt(1 + x/d)", {{"p", 1, 3}, {"r", 3, 6}, {"x", 0.1, 5}, {"d", 0.5, 3}}},
      {"a*sin(w*t) + b*cos(w*t)", {{"a", 1, 3}, {"b", 1, 4}, {"w", 2, 6}, {"t", 0.1, 2}}}};
  for (const Law& each : laws) {
    const DrawnLaw law(each.text, each.inputs, 256);
    const auto found = found_in(law, SumTerms::few);
    ASSERT_TRUE(found) << each.text;
    EXPECT_LT(law.error_of(*found), 1e-9) << each.text << ": " << print(*found, law.names);
  }
}

TEST(FunctionSum, FindsProductsBeforeAndInFunctionsWithManyTerms) {
  const std::vector<Law> laws = {
      {"p + (q - p)*exp(-e/(k*t))",
       {{"p", 1, 2}, {"q", 3, 5}, {"e", 0.5, 3}, {"k", 0.8, 1.3}, {"t", 0.5, 2}}},
      {"x0*cos(w*t) + v0/w*sin(w*t)", {{"x0", 0.5, 2}, {"v0", -2, 2}, {"w", 1, 4}, {"t", 0.1, 3}}},
      {"a*b*tanh(3*x) - b", {{"a", 1, 4}, {"b", 1, 3}, {"x", -1, 1}}}};
  for (const Law& each : laws) {
    const DrawnLaw law(each.text, each.inputs, 300);
    EXPECT_FALSE(found_in(law, SumTerms::few)) << each.text;
    const auto found = found_in(law, SumTerms::many);
    ASSERT_TRUE(found) << each.text;
    EXPECT_LT(law.error_of(*found), 1e-9) << each.text << ": " << print(*found, law.names);
  }
}

TEST(FunctionSum, FindsNothingWhereThereIsNone) {
  const std::vector<DrawnInput> inputs = {{"a", 1, 4}, {"b", 1, 3}, {"x", 0.1, 2}};
  // A function in a function, noise, operators that lack it, one input, few rows.
  EXPECT_FALSE(found_in(DrawnLaw("a*exp(-b*tanh(x^2 + b))", inputs, 256), SumTerms::few));
  EXPECT_FALSE(found_in(DrawnLaw("a + b*exp(-2*x)", inputs, 256, 0.01), SumTerms::few));
  EXPECT_FALSE(found_in(DrawnLaw("a + b*atan(2*x)", inputs, 256), SumTerms::few,
                        find_operator_set("paper")));
  EXPECT_FALSE(found_in(DrawnLaw("2 + exp(-2*x)", {{"x", 0.1, 2}}, 256), SumTerms::few));
  EXPECT_FALSE(found_in(DrawnLaw("a + b*exp(-2*x)", inputs, 50), SumTerms::few));
}

TEST(FunctionSum, NamesTheLawAmongTheLikelyUnderNoise) {
  const std::string text = "fc + (fs - fc)*exp(-(v/vs)^2)";
  const std::vector<DrawnInput> inputs = {
      {"fc", 1, 3}, {"fs", 2, 5}, {"v", 0.05, 3}, {"vs", 0.5, 2}};
  const DrawnLaw law(text, inputs, 300);
  const DrawnLaw noisy(text, inputs, 300, 0.01);
  const FiniteRows finite(noisy.data());
  Budget budget({});
  const std::vector<Expression> likely =
      relay::likely_function_sums(relay::LogRows(finite, 300), all_operators(), budget);
  // With the law's three terms and no others.
  EXPECT_TRUE(std::ranges::any_of(likely, [&](const Expression& formula) {
    return law.error_of(formula) < 2e-3 && formula.size() <= 24;
  }));
}

TEST(FunctionSum, EndsWithItsBudget) {
  const DrawnLaw law("a*b*tanh(3*x) - b", {{"a", 1, 4}, {"b", 1, 3}, {"x", -1, 1}}, 300);
  const FiniteRows finite(law.data());
  Budget budget({1000, 1e9});
  EXPECT_TRUE(relay::find_function_sums(relay::LogRows(finite, 300), all_operators(),
                                        SumTerms::many, budget)
                  .empty());
  EXPECT_LT(budget.spent(), 1'000'000u);
}

}  // namespace
}  // namespace tribench
