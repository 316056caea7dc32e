// SPDX-License-Identifier: MIT
#include "algorithms/expression/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/random.hpp"

namespace tribench::text_test {
namespace {

const std::vector<std::string> kNames = {"v", "g", "sgn_v"};

double value(const char* text, double v = 2, double g = 3) {
  Evaluator evaluator;
  const std::vector<double> point = {v, g, v > 0 ? 1.0 : -1.0};
  return evaluator.evaluate_at(parse(text, kNames), point);
}

TEST(Parse, BindsAsWritten) {
  EXPECT_EQ(value("-v^2"), -4);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("v - g - 1"), -2);
  EXPECT_EQ(value("12/v/g"), 2);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("(-2)^2"), 4);
  EXPECT_EQ(value("v^-1"), 0.5);
  EXPECT_EQ(value("v*-g"), -6);
  EXPECT_EQ(value("1.5e1 + .5"), 15.5);
  EXPECT_EQ(value("sgn(-g)*abs(-v)"), -2);
}

// Random tapes over every operation, constants of every magnitude, either sign.
Expression random_tape(RandomStream& random, int size) {
  if (size <= 1) {
    if (random.chance(0.5)) return Expression::variable(random.below(3));
    return Expression::constant(random.sign() * std::exp(random.uniform(-60, 60)));
  }
  const Op op = static_cast<Op>(2 + random.below(kOpCount - 2));
  if (arity(op) == 1) return Expression::unary(op, random_tape(random, size - 1));
  const int left = 1 + static_cast<int>(random.below(static_cast<std::uint64_t>(size - 1)));
  return Expression::binary(op, random_tape(random, left), random_tape(random, size - left));
}

TEST(Print, ReadsBackToTheSameTapeAndTheSameBits) {
  RandomStream random(key_of("print"));
  for (int i = 0; i < 20000; ++i) {
    const Expression formula = random_tape(random, 1 + static_cast<int>(random.below(30)));
    const std::string text = print(formula, kNames);
    ASSERT_EQ(parse(text, kNames), formula) << text;
  }
}

struct BadFormula {
  const char* text;
  const char* message;
};

TEST(Parse, SaysWhereTheMistakeIsAndHowToMendIt) {
  const BadFormula cases[] = {
      {"", "character 1: the formula ends"},
      {"v +", "character 4: the formula ends"},
      {"v g", "character 3: unexpected 'g'"},
      {"(v", "character 3: a '(' is never closed"},
      {"v)", "unexpected ')'"},
      {"exp v", "the function exp needs an argument"},
      {"expp(v)", "did you mean exp?"},
      {"log100(v)", "did you mean log10?"},
      {"tan", "'tan' is not an input"},
      {"sgn_w*v", "did you mean sgn_v?"},
      {"v**2", "write ^"},
      {"1e999", "out of range"},
      {"v + $", "'$' where a number"},
      {"v² + g", "character 2: unexpected '²'"},
      {"v*g + √v", "character 7: '√' where a number"},
  };
  for (const BadFormula& bad : cases) {
    try {
      parse(bad.text, kNames);
      FAIL() << bad.text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(bad.message)) << bad.text;
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  }
}

TEST(Parse, RefusesEndlessNestingButAcceptsTheLimit) {
  const auto nested = [](int levels) {
    return std::string(static_cast<std::size_t>(levels), '(') + "v" +
           std::string(static_cast<std::size_t>(levels), ')');
  };
  EXPECT_NO_THROW(parse(nested(kMaxNesting - 1), kNames));
  EXPECT_THROW(parse(nested(kMaxNesting + 1), kNames), Error);
  EXPECT_THROW(parse(std::string(100000, '-') + "v", kNames), Error);
}

TEST(Parse, LeavesHolesForWhatIsCalledAndNoFunction) {
  std::vector<std::string> names = {"v", "g"};
  std::vector<Hole> holes;
  const Expression formula = parse_with_holes("v*f(abs(v), g + 1)^2 - p()*exp(g)", names, holes);
  ASSERT_EQ(holes.size(), 2u);
  EXPECT_EQ(holes[0].name, "f");
  EXPECT_EQ(holes[0].arguments,
            (std::vector<Expression>{parse("abs(v)", names), parse("g + 1", names)}));
  EXPECT_TRUE(holes[1].arguments.empty());
  names.insert(names.end(), {"f", "p"});
  EXPECT_EQ(print(formula, names), "v*f^2 - p*exp(g)");
  EXPECT_THROW(parse_with_holes("f(v) + f(g)", std::vector<std::string>{"v", "g"}, holes), Error);
  EXPECT_THROW(parse("f(v)", std::vector<std::string>{"v"}), Error);
}

TEST(Print, WritesNoNameThatWouldReadBackAsSomethingElse) {
  const Expression formula = Expression::unary(Op::exp, Expression::variable(0));
  for (const char* name : {"x+y", "2", "1e5", "exp", "x;system(\"id\")", "q [deg]", ""}) {
    EXPECT_THROW(print(formula, std::vector<std::string>{name}), Error) << name;
  }
  EXPECT_EQ(print(formula, std::vector<std::string>{"q_deg"}), "exp(q_deg)");
}

TEST(Parse, KnowsTheFunctionsThatNoInputIsCalledBy) {
  for (const std::string_view name : kFunctionNames) {
    const Expression formula = parse(std::string(name) + "(v)", kNames);
    EXPECT_EQ(op_name(formula.node(formula.root()).op), name);
  }
}

// A name is one of these where it is called; a column may be called so.
TEST(Parse, WritesOutWhatOperationsSay) {
  const std::pair<const char*, const char*> forms[] = {
      {"tan(v + g)", "sin(v + g)/cos(v + g)"},
      {"2*sinh(v)", "2*(tanh(v)*((exp(v) + exp(-v))/2))"},
      {"cosh(v)^2", "((exp(v) + exp(-v))/2)^2"},
      {"g - log2(v)", "g - log(v)/0.6931471805599453"},
      {"asin(v)", "2*atan(v/(1 + sqrt((1 - v)*(1 + v))))"},
      {"acos(v)", "4*atan(sqrt(1 - v)/(1.4142135623730951 + sqrt(1 + v)))"},
      {"1/log10(tan(v))", "1/(log(sin(v)/cos(v))/2.302585092994046)"},
  };
  for (const auto& [text, written_out] : forms) {
    EXPECT_EQ(parse(text, kNames), parse(written_out, kNames)) << text;
  }
  std::vector<std::string> names;
  parse_collecting_names("log10*log10(x)", names);
  EXPECT_EQ(names, (std::vector<std::string>{"log10", "x"}));
  std::string nested = "v";
  for (int level = 0; level < 40; ++level) nested = "tan(" + nested + ")";
  try {
    parse(nested, kNames);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'tan' is sin(x)/cos(x) here"));
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
  }
}

// 1 - x*x has lost half of its digits where 1 - x is 1e-8, and pi/2 - asin(x) with it.
TEST(Parse, TheArcsAreExactToTheLastDigitsUpToTheirEnds) {
  const Expression asin = parse("asin(v)", kNames);
  const Expression acos = parse("acos(v)", kNames);
  Evaluator evaluator;
  const auto expect_at = [&](double x) {
    const std::vector<double> at = {x, 0, 0};
    constexpr double kUlps = 6 * std::numeric_limits<double>::epsilon();
    const double arc_sine = evaluator.evaluate_at(asin, at);
    EXPECT_LE(std::abs(arc_sine - std::asin(x)), kUlps * std::abs(std::asin(x))) << x;
    const double arc_cosine = evaluator.evaluate_at(acos, at);
    EXPECT_LE(std::abs(arc_cosine - std::acos(x)), kUlps * std::acos(x)) << x;
  };
  RandomStream random(2);
  for (const double x : {-1.0, -0.0, 0.0, 1e-300, 0.5, 1.0}) expect_at(x);
  for (int i = 0; i < 2000; ++i) {
    expect_at(random.uniform(-1, 1));
    const double near = 1 - std::pow(10.0, random.uniform(-16, 0));
    expect_at(near);
    expect_at(-near);
  }
}

// (exp(x) - exp(-x))/2 has no digit left where x is 1e-17.
TEST(Parse, TheHyperbolicSineIsExactToTheLastDigitsEverywhere) {
  const Expression formula = parse("sinh(v)", kNames);
  RandomStream random(1);
  Evaluator evaluator;
  constexpr double kUlp = std::numeric_limits<double>::epsilon();
  for (int i = 0; i < 5000; ++i) {
    const double v = random.sign() * std::pow(10.0, random.uniform(-300, 2.8));
    const double truth = std::sinh(v);
    EXPECT_NEAR(evaluator.evaluate_at(formula, std::vector<double>{v, v, v}), truth,
                6 * kUlp * std::abs(truth))
        << v;
  }
  EXPECT_EQ(value("sinh(v)", 0), 0);
}

TEST(Parse, CollectsNamesInOrderOfAppearance) {
  std::vector<std::string> names;
  parse_collecting_names("b + a*b", names);
  EXPECT_EQ(names, (std::vector<std::string>{"b", "a"}));
}

}  // namespace
}  // namespace tribench::text_test
