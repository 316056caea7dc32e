// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "algorithms/relay/collapse.hpp"
#include "algorithms/relay/index_fit.hpp"
#include "algorithms/relay/product_search.hpp"
#include "algorithms/relay/relation_search.hpp"
#include "algorithms/relay/scaled_function.hpp"
#include "algorithms/relay/wave_sum.hpp"
#include "algorithms/relay/waves.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"

namespace tribench {
namespace {

using testing::DrawnInput;
using testing::DrawnLaw;

const OperatorSet& full() { return find_operator_set("full"); }

constexpr std::size_t kMostRows = 512;

class Rows {
 public:
  explicit Rows(const DrawnLaw& law) : finite_(law.data()), logs_(finite_, kMostRows) {}
  const relay::LogRows& operator*() const { return logs_; }

 private:
  FiniteRows finite_;
  relay::LogRows logs_;
};

const std::vector<DrawnInput> kFive = {{"a", 0.1, 10, true, true},
                                       {"b", 1e-9, 1e-7, true},
                                       {"c", 1, 100, true},
                                       {"d", 0, 6.2},
                                       {"e", 1, 100, true}};

TEST(ProductSearch, FindsProductsOfPowersSinesAndDifferences) {
  for (const std::string text : {"3*a*sqrt(b)/c^2", "-2.5*b^2*sin(d)/a", "a*(c - e)*b/cos(d)^2",
                                 "7*b*exp(-2*d)*a/(c + e)^2"}) {
    const DrawnLaw law(text, kFive, 300);
    Budget budget({});
    const auto found = relay::find_product(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-10) << text << ": " << print(*found, law.names);
  }
}

TEST(ProductSearch, FindsProductsAmongMoreFactorsThanTheRowsDetermine) {
  const DrawnLaw law("a*exp(-(g*t))*cos(w*t)",
                     {{"a", 0.5, 3}, {"g", 0.05, 0.5}, {"t", 0, 6}, {"w", 1, 4}}, 150);
  Budget budget({});
  const auto found = relay::find_product(*Rows(law), full(), budget);
  ASSERT_TRUE(found);
  EXPECT_LT(law.error_of(*found), 1e-10) << print(*found, law.names);
}

TEST(ProductSearch, FindsNothingInASumOrUnderNoise) {
  Budget budget({});
  const DrawnLaw sum("a*c + e^2", kFive, 300);
  EXPECT_FALSE(relay::find_product(*Rows(sum), full(), budget));
  const DrawnLaw noisy("3*a*sqrt(b)/c^2", kFive, 300, 1e-3);
  EXPECT_FALSE(relay::find_product(*Rows(noisy), full(), budget));
}

TEST(RelationSearch, FindsSumsRootsReciprocalsRatiosAndExponentials) {
  const std::vector<DrawnInput> inputs = {
      {"a", 0.1, 10, true, true}, {"c", 1, 100, true}, {"e", 1, 100, true}};
  for (const std::string text :
       {"2*c^2 - 3*e + a*c", "a*sqrt(c^2 + 2*e^2)", "1/(1/c + 2/e)", "(c + e)/(1 + 0.1*c*e)",
        "5*exp(-3*c/e)/c", "4*c/sqrt(1 + 0.001*e^2)"}) {
    const DrawnLaw law(text, inputs, 300);
    Budget budget({});
    const auto found =
        relay::find_relation(*Rows(law), full(), relay::Columns::powers_alone, 400, budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-7) << text << ": " << print(*found, law.names);
  }
}

TEST(RelationSearch, LeavesOutTermsThatExplainNothing) {
  const std::vector<DrawnInput> masses = {{"m", 0.1, 10, true},
                                          {"x", 0.1, 10, true, true},
                                          {"n", 0.1, 10, true},
                                          {"z", 0.1, 10, true, true}};
  const DrawnLaw law("(m*x + n*z)/(m + n)", masses, 400);
  Budget budget({});
  const auto found =
      relay::find_relation(*Rows(law), full(), relay::Columns::powers_alone, 500, budget);
  ASSERT_TRUE(found);
  EXPECT_LT(law.error_of(*found), 1e-9);
  EXPECT_LE(constant_positions(*found).size(), 4U) << print(*found, law.names);
}

TEST(RelationSearch, FindsSumsWithCosinesOnlyWhereTheyAreAskedFor) {
  const DrawnLaw law("c^2 + e^2 - 2*c*e*cos(d)", {{"c", 1, 9}, {"d", 0, 6.2}, {"e", 1, 9}}, 300);
  Budget budget({});
  EXPECT_FALSE(relay::find_relation(*Rows(law), full(), relay::Columns::powers_alone, 400, budget));
  const auto found =
      relay::find_relation(*Rows(law), full(), relay::Columns::with_factors, 800, budget);
  ASSERT_TRUE(found);
  EXPECT_LT(law.error_of(*found), 1e-9) << print(*found, law.names);
}

// A logistic curve and two decays, rates and times among the inputs.
TEST(RelationSearch, FindsDecaysOfProducts) {
  for (const std::string text : {"k/(1 + a*exp(-r*t))", "k*exp(-r*t) + 2*a"}) {
    const DrawnLaw law(text, {{"k", 1, 9}, {"a", 1, 9}, {"r", 0.2, 2}, {"t", 0, 5}}, 300);
    Budget budget({});
    const auto found =
        relay::find_relation(*Rows(law), full(), relay::Columns::with_factors, 1500, budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-9) << print(*found, law.names);
  }
}

// Entropy, mixing, a logit; what survives, an annuity, savings.
TEST(RelationSearch, FindsLawsOfShares) {
  for (const std::string text : {"-(p*log(p)) - (1 - p)*log(1 - p)", "a*log(p/(1 - p))",
                                 "1 - (1 - p)^a", "p/(1 - (1 + p)^(-a))", "((1 + p)^a - 1)/p"}) {
    const DrawnLaw law(text, {{"p", 0.02, 0.9}, {"a", 1, 9}}, 200);
    Budget budget({});
    const auto found =
        relay::find_relation(*Rows(law), full(), relay::Columns::with_factors, 500, budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-9) << text << ": " << print(*found, law.names);
  }
}

TEST(RelationSearch, FindsSumsOfProductsOfWaves) {
  const DrawnLaw law("sin(a)*sin(b) + cos(a)*cos(b)*cos(d)",
                     {{"a", -1.5, 1.5}, {"b", -1.5, 1.5}, {"d", -3, 3}}, 200);
  Budget budget({});
  const auto found =
      relay::find_relation(*Rows(law), full(), relay::Columns::with_factors, 1000, budget);
  ASSERT_TRUE(found);
  EXPECT_LT(law.error_of(*found), 1e-9) << print(*found, law.names);
}

TEST(RelationSearch, FindsTheRootOfAQuadraticEquation) {
  const std::vector<DrawnInput> throws = {{"v", 5, 40}, {"a", 0.2, 1.3}, {"h", 1, 50}};
  const std::vector<DrawnInput> crank = {{"r", 0.02, 0.1}, {"a", 0, 6.2}, {"l", 0.15, 0.4}};
  const std::pair<std::string, std::vector<DrawnInput>> laws[] = {
      {"(v*sin(a) + sqrt(v^2*sin(a)^2 + 19.62*h))/9.81", throws},
      {"r*cos(a) + sqrt(l^2 - r^2*sin(a)^2)", crank},
      {"-(0.5*h) + sqrt(0.25*h^2 + v*h)", throws},
      {"2*h - sqrt(h^2 - 0.5*h*a)", throws}};
  for (const auto& [text, inputs] : laws) {
    const DrawnLaw law(text, inputs, 300);
    Budget budget({});
    const auto found =
        relay::find_root(*Rows(law), full(), relay::Columns::with_factors, 500, budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-7) << text << ": " << print(*found, law.names);
  }
  const DrawnLaw other("v + exp(-(a*h))", throws, 300);
  Budget budget({});
  EXPECT_FALSE(relay::find_root(*Rows(other), full(), relay::Columns::with_factors, 500, budget));
}

TEST(RelationSearch, KeepsItsBudgetAndFindsNothingUnderNoise) {
  const DrawnLaw law("2*c^2 - 3*e + a*c", kFive, 300);
  Budget little({.evaluations = 1000});
  EXPECT_FALSE(relay::find_relation(*Rows(law), full(), relay::Columns::powers_alone, 400, little));
  EXPECT_LE(little.spent(), 1000U);
  const DrawnLaw noisy("2*c^2 - 3*e + a*c", kFive, 300, 1e-3);
  Budget budget({});
  EXPECT_FALSE(
      relay::find_relation(*Rows(noisy), full(), relay::Columns::powers_alone, 400, budget));
}

// Nernst's law.
TEST(RelationSearch, FindsALogarithmAmongFourInputs) {
  const DrawnLaw law("e - 8.617e-5*t/n*log(q)",
                     {{"e", -1, 2}, {"t", 280, 350}, {"n", 1, 3}, {"q", 1e-3, 1e3, true}}, 256);
  Budget budget({});
  const auto found =
      relay::find_relation(*Rows(law), full(), relay::Columns::with_factors, 700, budget);
  ASSERT_TRUE(found);
  EXPECT_LT(law.error_of(*found), 1e-9) << print(*found, law.names);
}

TEST(Collapse, FindsWhatALawDependsOn) {
  const DrawnLaw law("a*c^2*tanh(3e8*b*e/c)", kFive, 400);
  Budget budget({});
  const auto found = relay::find_collapses(*Rows(law), full(), 1500, 3, budget);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(print(found[0].inner, law.names), "b*e/c");
  EXPECT_EQ(print(found[0].outer, law.names), "a*c^2");
  EXPECT_LT(found[0].roughness, 0.02);
}

// The logarithm is rough at four zeros: what is smooth lies between them.
TEST(Collapse, FindsTheProductThatAWaveIsOf) {
  const DrawnLaw law("i*cos(3.14159265*n*d/l)^2",
                     {{"i", 1, 5}, {"n", 1, 1.6}, {"d", 0.2, 1}, {"l", 0.4, 0.8}}, 256);
  Budget budget({});
  const auto found = relay::find_collapses(*Rows(law), full(), 1500, 3, budget);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(print(found[0].inner, law.names), "n*d/l");
  EXPECT_EQ(print(found[0].outer, law.names), "i");
  EXPECT_TRUE(found[0].is_smooth);
}

TEST(Collapse, FindsNoneWhereTwoVariablesRemain) {
  const DrawnLaw law("a*tanh(c/50)*(2 + cos(d + 0.03*e))", kFive, 400);
  Budget budget({});
  for (const relay::Collapse& collapse :
       relay::find_collapses(*Rows(law), full(), 1500, 3, budget)) {
    EXPECT_FALSE(collapse.is_smooth) << print(collapse.inner, law.names);
  }
}

TEST(IndexFit, FindsExponentialsWavesAndTheirReciprocals) {
  for (const std::string text : {"2*exp(-3*x) + 1", "4/(exp(2*x) - 1)", "sin(40*x)^2",
                                 "sqrt(1 + 0.5*cos(9*x))", "3*tanh(0.7*x)", "2*log(1 + 5*x)",
                                 "3*(exp(1.3*x) + exp(-1.3*x))/2", "1/(exp(x) - exp(-x))"}) {
    const DrawnLaw law(text, {{"x", 0.05, 4}}, 300);
    Budget budget({});
    const auto found = relay::find_function(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-6) << text << ": " << print(*found, law.names);
  }
}

TEST(ScaledFunction, FindsWhatIsLeftOfPlanckFinsAndRates) {
  for (const std::string text : {"3*x^3/(exp(2.5*x) - 1)", "2*sqrt(x)*tanh(1.7/sqrt(x))",
                                 "0.4*x^2*exp(-1.3/x)", "x*(sqrt(1 + 0.3*x^2) - 1)"}) {
    const DrawnLaw law(text, {{"x", 0.3, 5}}, 200);
    Budget budget({});
    const auto found = relay::find_scaled_function(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-8) << text << ": " << print(*found, law.names);
  }
  // Powers of a sum, from one of which the fit finds the others, and inputs of both signs.
  for (const std::string text :
       {"1 - 1/sqrt(1 + 0.7/x^2)", "1.4*(1 + 0.2*x^2)^3.5", "x/(2 + x^2)^1.7",
        "x*(exp(0.8*x) + exp(-0.8*x))", "2/x^2*(exp(x) - exp(-x))"}) {
    const DrawnLaw law(text, {{"x", text[0] == '1' ? 0.3 : -4.0, 5}}, 200);
    Budget budget({});
    const auto found = relay::find_scaled_function(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-8) << text << ": " << print(*found, law.names);
  }
  const DrawnLaw other("sin(3*x) + x", {{"x", 0.3, 5}}, 200);
  Budget budget({});
  EXPECT_FALSE(relay::find_scaled_function(*Rows(other), full(), budget));
}

// The input stays below a limit, far from it and just.
TEST(ScaledFunction, FindsWhatHasALimit) {
  for (const std::string text : {"9*(1/sqrt(1 - x^2/25.01) - 1)", "3 - sqrt(30 - x^2)",
                                 "log(1 - 0.15*x) + 2", "2*x/(1 - (x/6)^2)^0.7"}) {
    const DrawnLaw law(text, {{"x", 0.3, 5}}, 200);
    Budget budget({});
    const auto found = relay::find_scaled_function(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-8) << text << ": " << print(*found, law.names);
  }
}

TEST(Waves, FindsTwoWavesAndOneThatDecays) {
  for (const std::string text :
       {"1.5*sin(2.3*x + 0.4) + 0.7*sin(5.9*x - 1.1) + 0.2", "cos(10*x) + cos(11*x)",
        "1.3*exp(-0.4*x)*cos(3.1*x + 0.3) + 0.5", "exp(0.2*x)*sin(7*x)",
        "(0.5*cos(2*x) + 0.3*cos(5*x) - 0.7)/x^2", "x*(1 + exp(-0.3*x)*sin(4*x))"}) {
    const DrawnLaw law(text, {{"x", 0.3, 9}}, 200);
    Budget budget({});
    const auto found = relay::find_waves(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-8) << text << ": " << print(*found, law.names);
  }
  // Three waves, a chirp, and what a set of operators lacks.
  for (const std::string text : {"sin(2*x) + sin(3.3*x) + sin(7*x)", "sin(x^2)"}) {
    const DrawnLaw law(text, {{"x", 0.3, 9}}, 200);
    Budget budget({});
    EXPECT_FALSE(relay::find_waves(*Rows(law), full(), budget)) << text;
  }
  const DrawnLaw law("cos(10*x) + cos(11*x)", {{"x", 0.3, 9}}, 200);
  Budget budget({});
  EXPECT_FALSE(relay::find_waves(*Rows(law), find_operator_set("paper"), budget));
}

TEST(WaveSum, FindsWavesWhoseSizesOtherInputsSet) {
  for (const std::string text : {"a*sin(17*x + 0.6)", "a*sin(2*x) + b*cos(2*x) + 0.3*b",
                                 "2.1 + (0.2 + 0.05*a)*cos(31*x - 1)", "b - 0.4*x + sin(5.5*x)"}) {
    const DrawnLaw law(text, {{"x", 0, 3}, {"a", 1, 5}, {"b", -2, 2}}, 256);
    Budget budget({});
    const auto found = relay::find_wave_sum(*Rows(law), full(), budget);
    ASSERT_TRUE(found) << text;
    EXPECT_LT(law.error_of(*found), 1e-9) << text << ": " << print(*found, law.names);
  }
  // A chirp, a product that is none of the sizes, noise, and what a set of operators lacks.
  for (const std::string text : {"a*sin(x^2)", "a*b*sin(17*x)"}) {
    const DrawnLaw law(text, {{"x", 0, 3}, {"a", 1, 5}, {"b", -2, 2}}, 256);
    Budget budget({});
    EXPECT_FALSE(relay::find_wave_sum(*Rows(law), full(), budget)) << text;
  }
  const DrawnLaw law("a*sin(17*x)", {{"x", 0, 3}, {"a", 1, 5}}, 256, 0.01);
  Budget budget({});
  EXPECT_FALSE(relay::find_wave_sum(*Rows(law), full(), budget));
  EXPECT_FALSE(relay::find_wave_sum(*Rows(law), find_operator_set("paper"), budget));
}

}  // namespace
}  // namespace tribench
