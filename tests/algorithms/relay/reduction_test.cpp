// SPDX-License-Identifier: MIT
#include "algorithms/relay/reduction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "algorithms/relay/reduced_problem.hpp"
#include "algorithms/relay/scaling.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::DrawnLaw;

relay::Reductions reductions_of(const DrawnLaw& law) {
  const FiniteRows finite(law.data());
  Budget budget({});
  return relay::find_reductions(relay::LogRows(finite, 512), relay::Guesses::yes, budget);
}

// The inputs that are left, as texts; the outer product or term last.
std::vector<std::string> texts_of(const relay::Reduction& reduction, const DrawnLaw& law) {
  std::vector<std::string> texts;
  for (const Expression& input : reduction.inputs) texts.push_back(print(input, law.names));
  texts.push_back(print(reduction.outer, law.names));
  return texts;
}

bool has(const relay::Reductions& all, const DrawnLaw& law, relay::TargetForm form,
         const std::vector<std::string>& texts) {
  for (const relay::Reduction& reduction : all.list) {
    if (reduction.form == form && texts_of(reduction, law) == texts) return true;
  }
  return false;
}

TEST(Reduction, FindsTheProductsThatALawDependsOn) {
  const DrawnLaw gas("n*t/(v - n*b)", {{"n", 1, 5}, {"t", 2, 4}, {"v", 1, 5}, {"b", 0.02, 0.1}},
                     300);
  EXPECT_TRUE(has(reductions_of(gas), gas, relay::TargetForm::plain, {"n*b/v", "n*t/v"}) ||
              has(reductions_of(gas), gas, relay::TargetForm::plain, {"v/(n*b)", "n*t/v"}) ||
              has(reductions_of(gas), gas, relay::TargetForm::plain, {"v/(n*b)", "t/b"}));
}

// Near the pole the logarithm is rough; 1/y^2 is a polynomial.
TEST(Reduction, FindsProductsByAPowerWhereTheLogarithmIsRough) {
  const DrawnLaw gain("1/sqrt((1 - w^2*c)^2 + (w*r)^2)",
                      {{"w", 0.2, 3}, {"c", 0.5, 2}, {"r", 0.1, 2}}, 256);
  EXPECT_TRUE(has(reductions_of(gain), gain, relay::TargetForm::plain, {"w^2*c", "w*r", "1"}));
}

TEST(Reduction, FindsTermsAndDifferences) {
  const DrawnLaw sum("h + exp(a*b)", {{"h", 0, 5}, {"a", 0.2, 1}, {"b", 0.2, 1}}, 300);
  EXPECT_TRUE(has(reductions_of(sum), sum, relay::TargetForm::plain, {"a", "b", "h"}));
  const DrawnLaw shift("2 + cos(a - b)", {{"a", 0, 2}, {"b", 0, 2}}, 300);
  EXPECT_TRUE(has(reductions_of(shift), shift, relay::TargetForm::plain, {"a - b", "1"}));
}

TEST(Reduction, SaysNothingOfNoise) {
  const DrawnLaw drawn("a + b", {{"a", 1, 5}, {"b", 1, 5}}, 300, 10);
  for (const relay::Reduction& reduction : reductions_of(drawn).list) {
    EXPECT_TRUE(reduction.is_guess);
  }
}

TEST(ReducedProblem, BringsAFormulaBackToTheInputsItCameFrom) {
  const DrawnLaw law("a*exp(-(b*c))", {{"a", 1, 5}, {"b", 1, 2}, {"c", 1, 2}}, 100);
  const FiniteRows rows(law.data());
  const relay::ReducedProblem whole(law.inputs, rows);
  const relay::ReducedProblem fewer(
      whole, {relay::TargetForm::plain, false, parse("a", law.names), {parse("b*c", law.names)}});
  const relay::ReducedProblem logarithm(
      fewer, {relay::TargetForm::logarithm, true, parse("u", {{"u"}}), {parse("u", {{"u"}})}});
  const TrainingData data = logarithm.data();
  for (std::size_t r = 0; r < data.rows(); ++r) {
    EXPECT_NEAR(data.target[r], -2 * data.columns[0][r], 1e-9);
  }
  EXPECT_LT(law.error_of(logarithm.restored(parse("-2*u", {{"u"}}))), 1e-14);
}

void expect_two_variables(const DrawnLaw& law) {
  testing::FitOptions options;
  options.operators = "full";
  options.limits.evaluations = 4'000'000'000;
  const FitResult result = testing::run_fit(law.data(), "relay", options);
  const Expression& found = result.front[result.chosen];
  EXPECT_LT(law.error_of(found), 1e-10) << print(found, law.names);
  EXPECT_THAT(result.note, ::testing::HasSubstr("explained by fewer variables"));
}

// Laws in which two products of powers are left, from some hundred rows.
TEST(Relay, FindsAGasLawOfWhichTwoVariablesRemain) {
  expect_two_variables(
      {"n*8.3*t/(v - n*b) - a*n^2/v^2",
       {{"n", 1, 5}, {"t", 250, 500}, {"v", 1, 5}, {"b", 0.02, 0.1}, {"a", 100, 500}},
       250});
}
TEST(Relay, FindsAnInterestOfWhichTwoVariablesRemain) {
  expect_two_variables(
      {"p*(1 + r/n)^(n*t)", {{"p", 100, 1000}, {"r", 0.01, 0.1}, {"n", 1, 12}, {"t", 1, 20}}, 300});
}

}  // namespace
}  // namespace tribench
