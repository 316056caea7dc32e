// SPDX-License-Identifier: MIT
#include "algorithms/expression/property.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::property_test {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v", "g", "sgn_g"};
const InputBox kBox = {{-2, 2}, {-1, 1, 0}, {-60, 60}, {-1, 1, 2}};

const Verdict kProved = Verdict::proved_free;
const Verdict kRefuted = Verdict::refuted;

struct Known {
  std::string formula;
  Verdict verdict;
};

double f(const std::string& formula, const std::vector<double>& point) {
  return Evaluator().evaluate_at(parse(formula, kNames), point);
}

PropertyResult ask(const std::string& formula, PropertyQuestion question) {
  return prove_property(parse(formula, kNames), kBox, question);
}

void expect_all(const std::vector<Known>& table, const PropertyQuestion& question) {
  for (const Known& known : table) {
    SCOPED_TRACE(known.formula);
    const PropertyResult result = ask(known.formula, question);
    EXPECT_EQ(verdict_name(result.verdict), verdict_name(known.verdict)) << result.boxes;
    EXPECT_EQ(result.witness.has_value(), result.verdict == Verdict::refuted);
  }
}

TEST(Dissipative, IsDecidedForFrictionLaws) {
  const std::vector<Known> table = {
      {"3*sgn_v + 2*v", kProved},
      {"2*v", kProved},
      {"v^3", kProved},
      {"10*v + v^2", kProved},
      {"v + v^2", kRefuted},
      {"sgn_v*(8 + 4*exp(-abs(v/0.1)^2)) + 14.4*v", kProved},
      {"tanh(50*v)*(5 + 0.1*abs(g))", kProved},
      {"(5 + 0.01*g)*sgn_v + 2*v", kProved},
      {"(5 + 0.1*g)*sgn_v + 2*v", kRefuted},
      {"3*sgn_v + 2*v - 0.5", kProved},
      {"3*sgn_v + 2*v - 3.5", kRefuted},
      {"-v", kRefuted},
      {"3*sgn_v - 2*v", kRefuted},
      {"3*sgn_v - 1.4*v", kProved},
      {"v/(v^2 + 0.01)", kProved},
      {"0", kProved},
      {"1/v", kRefuted},  // not finite
  };
  expect_all(table, {.property = Property::dissipative});
}

TEST(Dissipative, IsRefutedByAPointWhereFrictionDrives) {
  const PropertyResult result = ask("3*sgn_v - 2*v", {.property = Property::dissipative});
  ASSERT_TRUE(result.witness);
  EXPECT_LT(f("3*sgn_v - 2*v", result.witness->point) * result.witness->point[0], 0);
}

TEST(Bounded, IsDecidedAgainstALimit) {
  expect_all({{"3*sgn_v + 2*v", kProved}, {"3*sgn_v + 2*v + 0.001*g", kRefuted}},
             {.property = Property::bounded, .limit = 7});
  expect_all({{"g*v", kProved}, {"g/v", kRefuted}}, {.property = Property::bounded});
  expect_all({{"v*exp(-v^2)", kProved}}, {.property = Property::bounded, .limit = 0.42889});
  expect_all({{"v*exp(-v^2)", kRefuted}}, {.property = Property::bounded, .limit = 0.42887});
}

TEST(Monotone, LooksBeyondTheStribeckRangeOnly) {
  const std::string stribeck = "sgn_v*(5 + 3*exp(-(v/0.1)^2)) + 2*v";
  expect_all({{stribeck, kRefuted},
              {"2*v + 3*sgn_v", kProved},
              {"v^3", kProved},
              {"tanh(5*v)", kProved},
              {"v^2", kRefuted},
              {"sgn_v*v^2", kProved},
              {"sin(v)", kRefuted},
              {"v + 0.01*g*v", kProved},
              {"v + 0.02*g*v", kRefuted}},
             {.property = Property::monotone});
  expect_all({{stribeck, kProved}}, {.property = Property::monotone, .from = 0.25});
  expect_all({{stribeck, kRefuted}}, {.property = Property::monotone, .from = 0.15});
}

TEST(Monotone, IsRefutedByTwoPointsBetweenWhichFrictionFalls) {
  const std::string formula = "sgn_v*(5 + 3*exp(-(v/0.1)^2)) + 2*v";
  const PropertyResult result = ask(formula, {.property = Property::monotone});
  ASSERT_TRUE(result.witness);
  const auto& [slow, fast, node] = *result.witness;
  EXPECT_LT(slow[0], fast[0]);
  EXPECT_EQ(slow[1], fast[1]);
  EXPECT_GT(f(formula, slow), f(formula, fast));
  EXPECT_TRUE(witness_json(*result.witness, kNames).starts_with("{\"points\": [{\"v\": "));
}

TEST(Monotone, ComparesTheTwoSidesOfAJump) {
  expect_all({{"v - sgn_v", kRefuted},
              {"v - sgn(v)", kRefuted},
              {"v + sgn(v)", kProved},
              {"v + sgn_v^2", kRefuted},
              {"v + 0.1*g*sgn_v", kRefuted},
              {"v + (7 + 0.1*g)*sgn_v", kProved},
              {"v + g + sgn_v*v^2", kProved},
              {"tanh(5*v)*(7 + 0.1*g) + sgn_g", kProved}},
             {.property = Property::monotone});
  expect_all({{"v - 0.05*sgn_v", kProved},
              {"v - sgn_v", kRefuted},
              {"v - sgn(v)", kRefuted},
              {"v - sgn(2*v)", kRefuted},
              {"v^3 - 3*v*exp(-1000*v^2)", kProved},
              {"v^2*sgn_v - 0.011*sgn(v^3)", kRefuted}},
             {.property = Property::monotone, .from = 0.1});
}

TEST(Monotone, IsRefutedByTwoPointsOnTwoSidesOfAJump) {
  for (const double from : {0.0, 0.1}) {
    const PropertyResult result = ask("v - sgn(v)", {.property = Property::monotone, .from = from});
    ASSERT_TRUE(result.witness);
    const auto& [slow, fast, node] = *result.witness;
    EXPECT_EQ(slow.size(), kNames.size());
    EXPECT_LE(slow[0], -from);
    EXPECT_GE(fast[0], from);
    EXPECT_GT(f("v - sgn(v)", slow), f("v - sgn(v)", fast));
  }
}

TEST(Monotone, AsksNothingOfTheSpeedsBelow) {
  expect_all({{"v + 1/(v - 0.1)", kRefuted}, {"1/v", kRefuted}, {"v - 0.01/v", kProved}},
             {.property = Property::monotone, .from = 0.5});
  const PropertyResult result = ask("-1/v", {.property = Property::monotone, .from = 0.5});
  ASSERT_TRUE(result.witness);
  EXPECT_LE(result.witness->point[0], -0.5);
  EXPECT_GE(result.witness->neighbour[0], 0.5);
}

// 3^40 cells are more than any machine has: a bound on the whole says what it can.
TEST(Properties, OfManySignsAreProvedOnTheWholeOrLeft) {
  std::vector<std::string> names = {"v"};
  std::string sum = "v";
  for (int k = 0; k < 40; ++k) {
    names.push_back("x" + std::to_string(k));
    sum += " + abs(" + names.back() + ")";
  }
  const InputBox box(names.size(), {-1, 1});
  const Expression formula = parse(sum, names);
  const auto verdict = [&](const PropertyQuestion& question) {
    return prove_property(formula, box, question).verdict;
  };
  EXPECT_EQ(verdict({.property = Property::finite}), kProved);
  EXPECT_EQ(verdict({.property = Property::bounded, .limit = 41}), kProved);
  EXPECT_EQ(verdict({.property = Property::bounded, .limit = 40}), Verdict::undecided);
  EXPECT_EQ(verdict({.property = Property::monotone}), Verdict::undecided);
  EXPECT_EQ(prove_free(parse("1/(" + sum + ")", names), box).verdict, Verdict::undecided);
}

// Nothing is proved of a question that asks nothing.
TEST(Monotone, NeedsTwoSpeedsOnASide) {
  const auto asked = [](double low, double high, double from) {
    const std::vector<std::string> names = {"v"};
    prove_property(parse("2*v", names), InputBox{{low, high}},
                   {.property = Property::monotone, .from = from});
  };
  EXPECT_THROW(asked(3, 3, 0), Error);
  EXPECT_THROW(asked(-1, 1, 1), Error);
  EXPECT_THROW(asked(-1, 1, 5), Error);
  EXPECT_NO_THROW(asked(3, 4, 0));
  EXPECT_NO_THROW(asked(-4, -3, 0));
  EXPECT_NO_THROW(asked(-1, 3, 1));
}

TEST(Odd, IsDecidedByFormOrByAPoint) {
  expect_all({{"3*sgn_v + 2*v", kProved},
              {"v^3 - 2*v", kProved},
              {"v*exp(-v^2)", kProved},
              {"sgn_v*(8 + 4*exp(-abs(v/0.1)^2)) + 14.4*v", kProved},
              {"tanh(3*v)*g", kProved},
              {"v/(1 + abs(v))", kProved},
              {"sin(v)*cos(v)", kProved},
              {"sgn_v*sqrt(v*sgn_v)", kProved},
              {"3*sgn_v + 2*v + 0.001", kRefuted},
              {"v^2", kRefuted},
              {"exp(v)", kRefuted},
              {"v + g", kRefuted},
              {"(8.452 - 0.215*sgn_v)*(1.842*v + sgn_v)", kRefuted}},
             {.property = Property::odd});
}

TEST(Properties, RefuseAQuestionThatMakesNoSense) {
  EXPECT_THROW(ask("v", {.property = Property::dissipative, .velocity = 1}), Error);
  EXPECT_THROW(ask("v", {.property = Property::monotone, .from = -1}), Error);
  // Of no point of the box: anything would be proved.
  const auto beyond = [](double low, double high, double from) {
    return prove_property(parse("-v", kNames), {{low, high}, {0, 1}},
                          {.property = Property::monotone, .from = from});
  };
  EXPECT_THROW(beyond(-1, 1, 5), Error);
  EXPECT_THROW(beyond(-1, 1, 1), Error);
  EXPECT_THROW(beyond(0, 0, 0), Error);
  EXPECT_EQ(beyond(-1, 1, 0.9).verdict, Verdict::refuted);
  EXPECT_THROW(prove_property(parse("v", kNames), {{0, 1}}, {.property = Property::odd}), Error);
}

}  // namespace
}  // namespace tribench::property_test
