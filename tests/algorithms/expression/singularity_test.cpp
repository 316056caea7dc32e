// SPDX-License-Identifier: MIT
//
// The curated table: formulas whose verdict is known, with every trap we could think of. All must
// be decided, and decided rightly.
#include "algorithms/expression/singularity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::singularity_test {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v", "g", "sgn_g"};

InputBox joint_box(double v, double g) { return {{-v, v}, {-1, 1, 0}, {-g, g}, {-1, 1, 2}}; }

struct Known {
  std::string formula;
  Verdict verdict;
  InputBox box = joint_box(2, 60);
};

// A witness is checked by hand: with the evaluator alone.
void expect_singular_at(const Expression& formula, const Witness& witness, const InputBox& box) {
  Evaluator evaluator;
  const Expression node = subtree(formula, witness.node);
  for (std::size_t j = 0; j < box.size(); ++j) {
    for (const auto& point : {witness.point, witness.neighbour}) {
      if (point.empty()) continue;
      if (box[j].sign_of) {
        const double x = point[*box[j].sign_of];
        EXPECT_EQ(point[j], x > 0 ? 1 : (x < 0 ? -1 : 0));
      } else {
        EXPECT_GE(point[j], box[j].low);
        EXPECT_LE(point[j], box[j].high);
      }
    }
  }
  const double value = evaluator.evaluate_at(node, witness.point);
  if (witness.neighbour.empty()) {
    EXPECT_FALSE(std::isfinite(value)) << value;
    return;
  }
  EXPECT_NE(std::signbit(value), std::signbit(evaluator.evaluate_at(node, witness.neighbour)));
  EXPECT_NE(value, 0);
  int steps = 0;
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (witness.point[j] == witness.neighbour[j]) continue;
    EXPECT_EQ(std::nextafter(witness.point[j], 1e300), witness.neighbour[j]);
    ++steps;
  }
  EXPECT_EQ(steps, 1);
}

const Verdict kFree = Verdict::proved_free;
const Verdict kRefuted = Verdict::refuted;

const std::vector<Known> kTable = {
    // no division at all
    {"v", kFree},
    {"3*v + 2*sgn_v", kFree},
    {"(3.66*v + 8.52*sgn_v - 0.44)*exp(-0.78*v^2 + 1.26*v*sgn_v + 0.02*v - 0.02*sgn_v)", kFree},
    {"sgn_v*(1193 + (8.629 - 1193)*exp(-abs(v/47.65)^8.827)) + 14.44*v", kFree},
    {"(-0.663*v + 0.014*g + 1.64*sgn_v - 10.159)*sqrt(abs(0.167*v - 0.076*g - 0.467*sgn_v))",
     kFree},
    {"exp(v) + exp(exp(sgn_v)) - 9.899", kFree},
    // denominators without a zero
    {"1/(v^2 + 1)", kFree},
    {"1/(v^2 - 2*v + 2)", kFree},
    {"1/(v*v - 2*v + 2)", kFree},
    {"v/(v^2 - 0.6*v + 0.0901)", kFree},
    {"1/(v^2 - 0.6*v + 0.090001)", kFree},
    {"1/(v^4 - v^2 + 0.2501)", kFree},
    {"g/(v^2 + 0.001*g^2 + 0.1)", kFree},
    {"1/(v^2 + g^2 - 1.9*v*g + 0.5)", kFree},
    {"1/(exp(v) - v)", kFree},
    {"1/(2 + sin(v*g))", kFree},
    {"1/(1.0001 - tanh(v))", kFree},
    {"1/(1 + exp(-40*v))", kFree},
    {"tanh(10*v)/(1 + abs(v)/0.1)", kFree},
    {"1/(cos(v) + 0.4162)", kFree},
    {"(v^3 - 1)/(v^2 + v + 1)", kFree},
    {"1/(v^6 - 3*v^4 + 3*v^2 + 1)", kFree},
    // denominators with a zero that a double hits
    {"1/v", kRefuted},
    {"1/(v - 0.3)", kRefuted},
    {"v/v", kRefuted},
    {"(v - 0.5)/(v - 0.5)", kRefuted},
    {"sin(v)/v", kRefuted},
    {"(exp(v) - 1)/v", kRefuted},
    {"1/sgn_v", kRefuted},
    {"1/(sgn_v*sgn_g)", kRefuted},
    {"1/(g - 17.25)", kRefuted},
    {"v^-1", kRefuted},
    {"abs(v)^-0.5", kRefuted},
    // double roots and touching roots
    {"1/(v^2 - 2*v + 1)", kRefuted},
    {"1/(v - 0.3)^2", kRefuted},
    {"1/(v^4 - 4*v^2 + 4)", kRefuted},
    {"1/(v^2 - 2)^2", kRefuted},
    {"1/abs(v^2 - 2)", kRefuted},
    {"(v^2 - 2)^-2", kRefuted},
    {"1/((v - 0.3)^2 + (g - 1)^2)", kRefuted},
    {"1/(v - g)^2", kRefuted},
    {"1/(1 - cos(v))", kRefuted},
    {"1/(v^2 - 0.6*v + 0.09)", kRefuted},
    // poles that no double hits, and poles hidden between grid points
    {"1/(v^2 - 2)", kRefuted},
    {"1/(v^3 - 0.7)", kRefuted},
    {"1/(exp(v) - 2)", kRefuted},
    {"1/(v + 0.0001234567)", kRefuted},
    {"1/((v - 1.00007)*(v - 1.00008))", kRefuted},
    {"1/(v^2 - 1.00001*v + 0.2500049)", kRefuted},
    {"1/(g*v - 119.9999)", kRefuted},
    {"1/(v^2 + g^2 - 1)", kRefuted},
    {"1/(exp(-1e8*(v - 0.123)^2) - 0.5)", kRefuted},
    {"1/sin(3*v + 1)", kRefuted},
    // signs: the cases are not independent of the velocity
    {"1/(v + 3*sgn_v + 0.5)", kFree, {{0.01, 2}, {-1, 1, 0}}},
    {"1/(v + 2*sgn_v + 3)", kRefuted},
    {"1/(v + 2*sgn_v + 1.5)", kFree, {{-0.4, 2}, {-1, 1, 0}}},
    {"1/(1 + v*sgn_v)", kFree},
    {"1/(2 + sgn_v*sgn_g)", kFree},
    {"1/(g*sgn_g + abs(v) + 0.01)", kFree},
    {"sqrt(sgn_v*v)", kFree},
    {"sqrt(v + (v + v)*sgn_v)", kFree},
    {"sqrt(v*abs(g - sgn_v*g)^2*sgn_v)", kFree},
    {"1/(v - 0.5*v*sgn_v + 1e-9*sgn_v)", kRefuted},
    {"sqrt(v*sgn(v))", kFree},
    {"log(1 + g*sgn_g)", kFree},
    {"1/(sgn(v) + 0.5)", kFree},
    {"1/(sgn(v - 0.3) + 0.5)", kFree},
    {"1/(sgn(v - 0.3) - 1)", kRefuted},
    {"1/sgn(v^2 - 2)", kRefuted},
    {"log(sqrt(cos(v)*cos(v)))", kRefuted},
    {"1/(tanh(2.718) - v)", kRefuted},
    {"1/(sgn(v^2 - 2) + 0.5*sgn_g + 0.25)", kFree},
    {"sgn_v/(abs(v) + 1e-300)", kFree},
    {"v/(v + 2*sgn_v + 3)", kFree, {{-0.9, 2}, {-1, 1, 0}}},
    // domains
    {"sqrt(v)", kRefuted},
    {"sqrt(v + 2)", kFree},
    {"sqrt(2*v + 4)", kFree},
    {"sqrt(v + 1.9999999)", kRefuted},
    {"sqrt((v - 0.3)^2 - 1e-12)", kRefuted},
    {"sqrt(v^2 - 0.6*v + 0.0899999)", kRefuted},
    {"sqrt(v^2 - 0.6*v + 0.0900001)", kFree},
    {"sqrt((v - 0.3)^2)", kFree},
    {"sqrt(1 - sin(v)^2)", kFree},
    {"log(v)", kRefuted},
    {"log(abs(v))", kRefuted},
    {"log(v^2 + 1e-12)", kFree},
    {"log(1 + exp(v))", kFree},
    {"log(v + 2)", kRefuted},
    {"log(exp(v) - v - 1)", kRefuted},
    {"v^0.5", kRefuted},
    {"v^g", kRefuted},
    {"abs(v)^1.5", kFree},
    {"(v + 3)^g", kFree},
    // overflow, and results that leave the range in between only
    {"exp(exp(exp(3*v)))", kRefuted},
    {"exp(g^2)", kRefuted},
    {"exp(11.8*g)", kFree},
    {"exp(11.9*g)", kRefuted},
    {"1/exp(12*g)", kRefuted},
    {"1/(1 + exp(12*g))", kRefuted},
    {"exp(-g^2)", kFree},
    {"1/exp(-g^2)", kRefuted},
    {"(1e200*g)^2*1e-300", kRefuted},
    {"1/(1e-320*v + 1e-319)", kRefuted},
    {"exp(710 - 1e9*(v - 0.123)^2)", kRefuted},
    {"exp(700 - 1e9*(v - 0.123)^2)", kFree},
    {"g^174", kRefuted},
    {"g^173", kFree},
};

TEST(SingularityTable, HasAtLeastSixtyFormulas) { EXPECT_GE(kTable.size(), 60U); }

TEST(SingularityTable, DecidesEveryFormulaRightly) {
  for (const Known& known : kTable) {
    SCOPED_TRACE(known.formula);
    const Expression formula = parse(known.formula, kNames);
    const SingularityResult result = prove_free(formula, known.box);
    EXPECT_EQ(verdict_name(result.verdict), verdict_name(known.verdict))
        << result.boxes << " boxes "
        << (result.witness ? witness_json(*result.witness, kNames) : std::string());
    EXPECT_EQ(result.witness.has_value(), result.verdict == Verdict::refuted);
    if (result.witness) expect_singular_at(formula, *result.witness, known.box);
  }
}

TEST(Singularity, SaysWhereAPoleLiesBetweenTwoDoubles) {
  const InputBox box = {{0, 2}};
  const std::vector<std::string> names = {"v"};
  const SingularityResult result = prove_free(parse("1/(v^2 - 2)", names), box);
  ASSERT_EQ(result.verdict, Verdict::refuted);
  EXPECT_EQ(witness_json(*result.witness, names),
            "{\"between\": [{\"v\": 1.414213562373095}, {\"v\": 1.4142135623730951}]}");
}

TEST(Singularity, GivesTheSameAnswerTwice) {
  for (const Known& known : kTable) {
    const Expression formula = parse(known.formula, kNames);
    const SingularityResult a = prove_free(formula, known.box);
    const SingularityResult b = prove_free(formula, known.box);
    EXPECT_EQ(a.boxes, b.boxes);
    ASSERT_EQ(a.witness.has_value(), b.witness.has_value());
    if (a.witness) {
      EXPECT_EQ(a.witness->point, b.witness->point);
    }
  }
}

TEST(Singularity, SaysUndecidedWithTheSmallestBoxWhenTheBudgetIsSpent) {
  const Expression formula = parse("1/(exp(v - 0.3) - v - 0.6999999)", kNames);
  const SingularityResult result = prove_free(formula, joint_box(2, 60), {.node_boxes = 200});
  EXPECT_EQ(result.verdict, Verdict::undecided);
  ASSERT_EQ(result.undecided_box.size(), 4U);
  EXPECT_LT(result.undecided_box[0].high - result.undecided_box[0].low, 4);
}

TEST(Singularity, RefusesABoxThatIsNone) {
  const Expression formula = parse("v + g", kNames);
  EXPECT_THROW(prove_free(formula, {{0, 1}}), Error);
  EXPECT_THROW(prove_free(formula, {{1, 0}, {0, 0, 0}, {0, 1}}), Error);
  EXPECT_THROW(prove_free(formula, {{0, 1}, {0, 0, 7}, {0, 1}}), Error);
  EXPECT_THROW(prove_free(formula, {{0, std::nan("")}, {0, 0, 0}, {0, 1}}), Error);
}

TEST(Singularity, CountsAConstantThatIsNotFinite) {
  const Expression formula = Expression::constant(INFINITY);
  EXPECT_EQ(prove_free(formula, {}).verdict, Verdict::refuted);
}

}  // namespace
}  // namespace tribench::singularity_test
