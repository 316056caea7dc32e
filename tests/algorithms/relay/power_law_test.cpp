// SPDX-License-Identifier: MIT
#include "algorithms/relay/power_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "algorithms/relay/product_search.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"

namespace tribench {
namespace {

using testing::DrawnInput;
using testing::DrawnLaw;

std::vector<Expression> laws_of(const DrawnLaw& law) {
  const FiniteRows rows(law.data());
  Budget budget({});
  return relay::likely_power_laws(relay::LogRows(rows, 300), find_operator_set("full"), budget);
}

// How near the nearest is to the law without noise.
double nearest_error(const std::vector<Expression>& laws, const DrawnLaw& exact) {
  double nearest = HUGE_VAL;
  for (const Expression& law : laws) nearest = std::min(nearest, exact.error_of(law));
  return nearest;
}

std::vector<DrawnInput> over_decades(const std::string& names, double high) {
  std::vector<DrawnInput> inputs;
  for (const char name : names) inputs.push_back({std::string(1, name), 1, high, true});
  return inputs;
}

// A tenth of the target's size is far more than most of its values: many are negative.
TEST(PowerLaws, AreFoundWhereNoiseIsLargerThanMostOfTheTarget) {
  const std::string form = "1.7*a^0.4*b^1.74/(c^2*d^0.67)";
  const std::vector<DrawnInput> inputs = over_decades("abcdz", 20);
  const DrawnLaw noisy(form, inputs, 300, 0.1);
  ASSERT_GT(std::ranges::count_if(noisy.target, [](double y) { return y < 0; }), 60);
  EXPECT_LT(nearest_error(laws_of(noisy), DrawnLaw(form, inputs, 2000, 0, 2)), 0.05);
}

TEST(PowerLaws, NegativeOnesToo) {
  const std::string form = "-3*a^1.3/b^0.7";
  const std::vector<DrawnInput> inputs = over_decades("ab", 20);
  const DrawnLaw noisy(form, inputs, 300, 0.01);
  EXPECT_LT(nearest_error(laws_of(noisy), DrawnLaw(form, inputs, 2000, 0, 2)), 0.003);
}

// 0.6 is no half where the rows tell it from one; what they do not tell is one.
TEST(PowerLaws, HaveHalvesForExponentsThatTheRowsCannotTellFromThem) {
  const DrawnLaw noisy("2*a^0.6*sqrt(b)", over_decades("ab", 20), 300, 0.01);
  const std::vector<Expression> laws = laws_of(noisy);
  ASSERT_GE(laws.size(), 2U);
  const std::string free = print(laws[0], noisy.names);
  const std::string halves = print(laws[1], noisy.names);
  EXPECT_NE(free.find("b^0."), std::string::npos) << free;
  EXPECT_EQ(halves.find("b^"), std::string::npos) << halves;
  EXPECT_NE(halves.find("a^0."), std::string::npos) << halves;
}

TEST(PowerLaws, LeaveOutWhatMattersLeastFirst) {
  const DrawnLaw noisy("2*a^1.3*c^0.2", over_decades("abc", 20), 300, 0.01);
  for (const Expression& law : laws_of(noisy)) {
    const std::string formula = print(law, noisy.names);
    const bool has_c = formula.find('c') != std::string::npos;
    EXPECT_TRUE(has_c || formula.find('b') == std::string::npos) << formula;
    EXPECT_NE(formula.find('a'), std::string::npos) << formula;
  }
}

TEST(PowerLaws, AreOfInputsThatHaveLogarithms) {
  const DrawnLaw noisy("2*a^1.3*(1 + b)", {{"a", 1, 20, true}, {"b", 0, 0}}, 300, 0.01);
  const std::vector<Expression> laws = laws_of(noisy);
  ASSERT_FALSE(laws.empty());
  for (const Expression& law : laws) {
    EXPECT_EQ(print(law, noisy.names).find('b'), std::string::npos);
  }
}

// Six decades, most of them below the noise: the regression of log |y| does not see them.
TEST(LikelyProducts, HaveAnActivationEnergyWhereNoiseIsLargerThanMostOfTheTarget) {
  const std::string form = "1.3e12*a*exp(-10223/t)";
  const std::vector<DrawnInput> inputs = {{"t", 280, 450}, {"a", 1, 7, true}};
  const DrawnLaw noisy(form, inputs, 200, 0.01);
  const FiniteRows rows(noisy.data());
  Budget budget({});
  const std::vector<Expression> likely =
      relay::likely_products(relay::LogRows(rows, 300), find_operator_set("full"), budget);
  EXPECT_LT(nearest_error(likely, DrawnLaw(form, inputs, 2000, 0, 2)), 0.005);
}

TEST(PowerLaws, OfMoreInputsThanRowsTellAreNotLookedFor) {
  const DrawnLaw few("a*b", over_decades("abcd", 20), 19, 0.01);
  EXPECT_TRUE(laws_of(few).empty());
}

}  // namespace
}  // namespace tribench
