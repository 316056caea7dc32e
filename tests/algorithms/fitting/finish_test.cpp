// SPDX-License-Identifier: MIT
#include "algorithms/fitting/finish.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::finish_test {
namespace {

const std::vector<std::string> kNames = {"v", "g", "t"};
const InputBox kBox = {{0.5, 5}, {0.5, 5}, {0.5, 5}};

// Rows in the box with the values of a law, and noise.
class Rows {
 public:
  explicit Rows(const std::string& law, double noise = 0) {
    RandomStream random(key_of("finish"));
    columns_.resize(3);
    for (std::vector<double>& column : columns_) {
      for (int r = 0; r < 200; ++r) column.push_back(random.uniform(0.5, 5));
      pointers_.push_back(column.data());
    }
    target_.resize(200);
    Evaluator().evaluate(parse(law, kNames), table(), target_);
    for (double& y : target_) y += noise * random.normal();
  }

  Inputs table() const { return {pointers_, target_.size()}; }
  double mean_square(const Expression& formula) const {
    return Evaluator().sum_squared_errors(formula, table(), target_).sum;
  }
  Expression finish(const std::string& formula, const char* operators = "full") const {
    const OperatorSet& set = find_operator_set(operators);
    FormulaFinisher finisher(table(), target_, kBox,
                             [&](const Expression& f) { return set.admits(f); });
    const Expression finished = finisher.finish(parse(formula, kNames));
    EXPECT_EQ(finisher.finish(finished), finished) << formula;
    return finished;
  }
  std::string text(const std::string& formula, const char* operators = "full") const {
    return print(finish(formula, operators), kNames);
  }

 private:
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
  std::vector<double> target_;
};

TEST(Finish, WritesTheLawShortly) {
  EXPECT_EQ(Rows("v*g").text("1*(v*g)"), "v*g");
  EXPECT_EQ(Rows("v/g").text("v/g - 0"), "v/g");
  EXPECT_EQ(
      paper_complexity(Rows("v*g/t^2*8971428571.428572").finish("v*g/tanh(3.5e-09*t^2)*31.4")), 7);
}

TEST(Finish, NamesConstantsThatTheRowsCannotTellFromNumbersWithAName) {
  EXPECT_EQ(Rows("0.5*v*g^2").text("0.49999999731*v*g^2"), "0.5*v*g^2");
  EXPECT_EQ(Rows("2*v + g/3").text("2.0000000004*v + 0.33333333321*g"),
            print(parse("2*v + 0.3333333333333333*g", kNames), kNames));
  const Expression circle = Rows("v*sin(g*3.141592653589793)").finish("v*sin(g*3.1415926512)");
  EXPECT_EQ(print(circle, kNames), "v*sin(g*3.141592653589793)");
  EXPECT_EQ(Rows("v + g").text("1.0000000001*v + g + 1e-12"), "v + g");
  // As pysr left the laws of a public set.
  EXPECT_EQ(paper_complexity(Rows("v*g/t").finish(
                "1.0000000000000007*(t + -3.98e-18)^-0.9999999999999998*(v*g)")),
            5);
  EXPECT_EQ(paper_complexity(
                Rows("(1 - cos(v*g))/2")
                    .finish("-0.49999999999999994*(cos(v*g) + -0.9999999999999297) + 3.5e-14")),
            6);
  EXPECT_EQ(paper_complexity(Rows("3*v*g").finish("(3 + -1.2e-15*exp(-3*t))*v*g")), 4);
}

TEST(Finish, NamesTogetherWhatOneByOneCannotMove) {
  EXPECT_EQ(paper_complexity(Rows("1/(exp(g*t - v) + 1)")
                                 .finish("1/(0.9999999999978813*exp(-0.9999999999956087*v + "
                                         "0.9999999999963511*g*t) + 0.9999999999980798) - "
                                         "6.700637707334459e-13")),
            paper_complexity(parse("1/(exp(g*t - v) + 1)", kNames)));
  EXPECT_EQ(Rows("0.0231*v + g").text("0.02309999999999994*v + g"), "0.0231*v + g");
  // One without a name is fitted beside them, be it by 1e-11 of itself.
  const Expression flow = Rows("v*(1 + 0.2*g^2)^3.5")
                              .finish("0.00357770876414*v*(g^2 + 4.999999999963)^3.49999999998854");
  EXPECT_EQ(std::ranges::count(flow.nodes(), Node::constant(5)), 1);
  EXPECT_EQ(std::ranges::count(flow.nodes(), Node::constant(3.5)), 1);
}

TEST(Finish, WritesPowersAsPowersAndClearsFractionsWithinFractions) {
  EXPECT_EQ(Rows("v*g^(1/t)").text("v*exp(2*log(sqrt(g))/t)"), "v*g^(1/t)");
  EXPECT_EQ(Rows("v^g").text("exp(log(v)*g)"), "v^g");
  EXPECT_EQ(Rows("sqrt(v)*exp(0.15*t)").text("exp(0.5*(log(v) + 0.3*t))"), "sqrt(v)*exp(0.15*t)");
  EXPECT_EQ(Rows("3*t*v^-1.5").text("t*exp(1.5*(0.7324081924454065 - log(v)))"), "3*t*v^-1.5");
  EXPECT_EQ(Rows("(v/g)^2.3").text("exp(2.3*(log(v) - log(g)))"), "(v/g)^2.3");
  EXPECT_EQ(paper_complexity(Rows("v*(1 + g)/(t - g)").finish("v*(1/g + 1)/(t/g - 1)")),
            paper_complexity(parse("v*(1 + g)/(t - g)", kNames)));
}

// As relay left laws that it found: what a fit does not tell is chosen so that numbers have names.
TEST(Finish, TakesACommonMultipleOutOfASum) {
  EXPECT_EQ(Rows("v/2*(sqrt(1 + 8*g^2) - 1)")
                .text("v*(-0.5000000000074726 + 0.48699555101030756*sqrt(1.054119922283723 + "
                      "8.4329593771236*g^2))"),
            "v*(0.5*sqrt(8*g^2 + 1) - 0.5)");
  EXPECT_EQ(paper_complexity(Rows("t*(1 - 1/sqrt((g/v)^2 + 1))")
                                 .finish("t*(1 + -0.9901356676377047*(0.9803686403283625 + "
                                         "0.9803686403283585/(v/g)^2)^-0.5)")),
            paper_complexity(parse("(1 - ((g/v)^2 + 1)^-0.5)*t", kNames)));
  const Expression ratio =
      Rows("v*(1 + v)/(3*g + (2 + v)^2)")
          .finish(
              "v*(1.6458333333315358 + 1.6458333333322395*v)/(4.9374999999966276*g + "
              "6.583333333333333 + v*(6.5833333333318 + 1.6458333333322093*v))");
  for (const Node& node : ratio.nodes()) {
    if (node.is_constant()) {
      EXPECT_EQ(3 * node.value, std::round(3 * node.value));
    }
  }
  // Where every multiple has a number without a name, none is better.
  EXPECT_EQ(Rows("sqrt(1.0541199 + 8.4211*g)*v").text("sqrt(1.0541199 + 8.4211*g)*v"),
            "sqrt(1.0541199 + 8.4211*g)*v");
}

TEST(Finish, TakesTheWholePartOutOfAFraction) {
  EXPECT_EQ(paper_complexity(
                Rows("v*g/(v + g)")
                    .finish("(-1.5556349186104048 + (1 - 1.5556349186104048/g)*v)/(v/g + 1) + "
                            "1.5556349186104048")),
            paper_complexity(parse("v/(v/g + 1)", kNames)));
  EXPECT_EQ(Rows("2 + t/(v + g)").text("(t + 2*v + 2*g)/(v + g)"), "t/(v + g) + 2");
}

TEST(Finish, LeavesConstantsToTheRowsUnderNoise) {
  const Rows rows("2*v + g", 0.1);
  const Expression fitted = parse("2.0013*v + 0.9987*g", kNames);
  EXPECT_EQ(rows.finish("2.0013*v + 0.9987*g"), fitted);
}

TEST(Finish, KeepsToTheOperatorsOfTheSetOrOfTheFormula) {
  EXPECT_EQ(Rows("v*g + v*t").text("sqrt(v)*sqrt(v)*(g + t)", "paper"), "v*(g + t)");
  // A baseline's own division stays usable where the set has none.
  EXPECT_EQ(Rows("v/g").text("v/g + 0", "paper"), "v/g");
}

TEST(Finish, AnswersRowsWithoutAValueWithTheFormulaItself) {
  EXPECT_EQ(Rows("v").text("log(v - 3) + 0*g"), "log(v - 3) + 0*g");
}

TEST(Finish, IsLongerByOneForAProof) {
  const std::vector<double> t = {-2, -1, 1, 2, 3};
  std::vector<double> target;
  for (const double x : t) target.push_back(17 * x / (x + 237));
  const double* column = t.data();
  const std::vector<std::string> names = {"t"};
  const InputBox box = {{-2, 3}};
  FormulaFinisher finisher({{&column, 1}, t.size()}, target, box,
                           [](const Expression&) { return true; });
  const Expression finished = finisher.finish(parse("17/(237/t + 1)", names));
  EXPECT_EQ(print(finished, names), "17*t/(t + 237)");
  EXPECT_EQ(prove_free(finished, box).verdict, Verdict::proved_free);
}

// Where the inputs are above 0.
TEST(Finish, MergesPowersOfOneBaseAndTakesFactorsBelowARoot) {
  const std::vector<std::string> names = {"x", "y"};
  std::vector<double> x;
  std::vector<double> y;
  for (int r = 0; r < 40; ++r) {
    x.push_back(0.1 + 0.2 * r);
    y.push_back(9 - 0.17 * r);
  }
  const std::vector<const double*> columns = {x.data(), y.data()};
  const InputBox box = {{0.1, 10}, {0.1, 10}};
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"3*x*sqrt(x)", "3*x^1.5"},
      {"4*x/sqrt(x) + 1", "4*sqrt(x) + 1"},
      {"y*sqrt((x/y)^2 + 1)", "sqrt(x^2 + y^2)"},
      {"26*x*(26.66*sqrt(x))^-0.5", "5*x^0.75"},
      {"sqrt(x)^1.2 + y", "x^0.6 + y"}};
  for (const auto& [given, shortest] : pairs) {
    std::vector<double> target(x.size());
    Evaluator().evaluate(parse(given, names), {columns, x.size()}, target);
    FormulaFinisher finisher({columns, x.size()}, target, box,
                             [](const Expression&) { return true; });
    const Expression finished = finisher.finish(parse(given, names));
    EXPECT_EQ(node_count(finished), node_count(parse(shortest, names)))
        << given << " -> " << print(finished, names);
  }
}

TEST(Finish, NamesNoConstantThatKeepsThePoleAway) {
  const Rows rows("1/(g - 0.4999999999999)");
  const Expression finished = rows.finish("1/(g - 0.4999999999999)");
  EXPECT_EQ(prove_free(finished, kBox).verdict, Verdict::proved_free) << print(finished, kNames);
}

TEST(Finish, IsNeverWorseNorLongerNorMoreSingular) {
  RandomStream random(key_of("finish random"));
  int shorter = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Expression formula = testing::random_formula(random, {.inputs = 3});
    const Rows rows(trial % 2 == 0 ? print(formula, kNames) : "v*g + t", trial % 3 == 0 ? 0.1 : 0);
    const double before = rows.mean_square(formula);
    if (!std::isfinite(before)) continue;
    const Expression finished = rows.finish(print(formula, kNames));
    double size = rows.mean_square(Expression::constant(0));
    EXPECT_LE(rows.mean_square(finished), before * (1 + 1e-8) + 1e-23 * size)
        << print(formula, kNames) << " -> " << print(finished, kNames);
    const bool was_proved = prove_free(formula, kBox).verdict == Verdict::proved_free;
    const bool is_proved = prove_free(finished, kBox).verdict == Verdict::proved_free;
    EXPECT_LE(paper_complexity(finished),
              paper_complexity(formula) + (is_proved && !was_proved ? 1 : 0));
    EXPECT_TRUE(is_proved || !was_proved) << print(formula, kNames);
    shorter += paper_complexity(finished) < paper_complexity(formula) ? 1 : 0;
  }
  EXPECT_GT(shorter, 50);
}

}  // namespace
}  // namespace tribench::finish_test
