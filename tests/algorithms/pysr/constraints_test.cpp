// SPDX-License-Identifier: MIT
#include "algorithms/pysr/constraints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/mutation.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr::constraints_test {
namespace {

const std::vector<std::string> kNames = {"v", "m", "t"};
const std::vector<Input> kInputs = {{"v", "m/s"}, {"m", "kg"}, {"t", "s"}};

Expression formula(const char* text) { return parse(text, kNames); }

TEST(Constraints, RefuseWhatIsTooLargeTooDeepOrNotInTheSet) {
  Options options;
  options.max_depth = 3;
  const Validator validator(options, find_operator_set("paper"), kInputs);
  EXPECT_TRUE(validator.admits(formula("v * m + t"), 5));
  EXPECT_FALSE(validator.admits(formula("v * m + t"), 4));
  EXPECT_FALSE(validator.admits(formula("exp(exp(exp(v)))"), 30));
  EXPECT_FALSE(validator.admits(formula("v / m"), 30));
  EXPECT_TRUE(validator.admits(formula("v^2"), 30));
}

TEST(Constraints, WeighSizesByOperatorVariableAndConstant) {
  Options options;
  options.operator_sizes = "exp=2.5; *=2";
  options.constant_size = 0.5;
  const Validator validator(options, find_operator_set("paper"), kInputs);
  EXPECT_EQ(validator.size(formula("exp(v) * 2")), 6);  // 2.5 + 1 + 2 + 0.5
}

TEST(Constraints, LimitArgumentsAndNesting) {
  Options options;
  options.argument_limits = "exp:3; *:-1,1";
  options.nested_limits = "exp>exp=0; sqrt>exp=1";
  const Validator validator(options, find_operator_set("paper"), kInputs);
  EXPECT_TRUE(validator.admits(formula("exp(v + m)"), 30));
  EXPECT_FALSE(validator.admits(formula("exp(v + m + t)"), 30));
  EXPECT_FALSE(validator.admits(formula("v * (m + t)"), 30));
  EXPECT_TRUE(validator.admits(formula("(m + t) * v"), 30));
  EXPECT_FALSE(validator.admits(formula("exp(exp(v))"), 30));
  EXPECT_TRUE(validator.admits(formula("exp(v) + exp(m)"), 30));
  EXPECT_TRUE(validator.admits(formula("sqrt(exp(v))"), 30));
}

TEST(Constraints, NameWhatTheyDoNotUnderstand) {
  Options options;
  options.nested_limits = "exp>ep=0";
  EXPECT_THROW(Validator(options, find_operator_set("paper"), kInputs), Error);
  options.nested_limits = "";
  options.argument_limits = "exp:1,2";
  EXPECT_THROW(Validator(options, find_operator_set("paper"), kInputs), Error);
}

TEST(Constraints, RejectEveryViolationAmongAMillionMutants) {
  Options options;
  options.max_depth = 6;
  options.nested_limits = "exp>exp=0";
  options.argument_limits = "sqrt:4";
  const OperatorSet& operators = find_operator_set("paper+div");
  const Validator validator(options, operators, kInputs);
  const Alphabet alphabet{operators, 3};
  RandomStream random(key_of("mutants"));
  Expression parent = formula("v * 2 + exp(m)");
  int admitted = 0;
  constexpr int kMutants = 1'000'000;
  for (int i = 0; i < kMutants; ++i) {
    const auto kind = static_cast<MutationKind>(random.below(index_of(MutationKind::simplify)));
    const auto child = mutate(kind, parent, alphabet, {}, random);
    if (!child || !validator.admits(*child, 20)) continue;
    ++admitted;
    // Counted once more, the slow way.
    ASSERT_LE(child->size(), 20u);
    ASSERT_LE(depth(*child), 6u);
    ASSERT_TRUE(operators.admits(*child));
    for (std::size_t node = 0; node < child->size(); ++node) {
      const Expression below = subtree(*child, node);
      if (child->node(node).op == Op::exp) {
        const auto nodes = below.nodes().first(below.size() - 1);
        ASSERT_EQ(std::ranges::count(nodes, Op::exp, &Node::op), 0);
      }
      if (child->node(node).op == Op::sqrt) ASSERT_LE(below.size(), 5u);
    }
    parent = *child;
  }
  EXPECT_GT(admitted, kMutants / 10);
}

TEST(Units, FollowTheRulesOfWildcards) {
  const std::vector<Dimension> inputs = {parse_unit("m/s"), parse_unit("kg"), parse_unit("s")};
  const auto agree = [&](const char* text, const char* target) {
    return units_agree(formula(text), inputs, parse_unit(target));
  };
  EXPECT_TRUE(agree("m * v / t", "N"));
  EXPECT_FALSE(agree("m * v", "N"));
  EXPECT_TRUE(agree("2.5 * m * v", "N"));    // a constant takes any unit
  EXPECT_TRUE(agree("m * v / t + 3", "N"));  // also as a summand
  EXPECT_FALSE(agree("m * v / t + v", "N"));
  EXPECT_FALSE(agree("exp(v)", "-"));
  EXPECT_TRUE(agree("exp(2 * v)", "-"));
  EXPECT_TRUE(agree("sqrt(v * v)", "m/s"));
  EXPECT_TRUE(agree("v ^ 2", "m^2/s^2"));
  EXPECT_THROW(parse_unit("furlong"), Error);
}

TEST(Units, AreAPenaltyWhenSoftAndARefusalWhenHard) {
  Options options;
  options.target_unit = "N";
  options.units = Units::soft;
  const Validator soft(options, find_operator_set("paper"), kInputs);
  EXPECT_DOUBLE_EQ(soft.unit_penalty(formula("v + m")), 1000);
  EXPECT_DOUBLE_EQ(soft.unit_penalty(formula("2 * v")), 0);
  EXPECT_TRUE(soft.admits(formula("v + m"), 30));
  options.units = Units::hard;
  const Validator hard(options, find_operator_set("paper"), kInputs);
  EXPECT_FALSE(hard.admits(formula("v + m"), 30));
}

TEST(Simplification, DropsWhatIsPointlessAndMergesConstants) {
  const auto simple = [](const char* text) { return print(simplified(formula(text)), kNames); };
  EXPECT_EQ(simple("v - v"), "0");
  EXPECT_EQ(simple("0 * exp(v) + m"), "m");
  EXPECT_EQ(simple("2 * (3 * v)"), "6*v");
  EXPECT_EQ(simple("(v + 2) + 3"), "v + 5");
  EXPECT_EQ(simple("exp(0) * v"), "v");
  EXPECT_EQ(simple("2 * 3 + v"), "6 + v");
}

TEST(Simplification, TakesOutCommonFactorsAndMultipliesExponentialsIntoOne) {
  const auto simple = [](const char* text) { return print(simplified(formula(text)), kNames); };
  EXPECT_EQ(simple("2 * v + 3 * v"), "v*5");
  EXPECT_EQ(simple("2 * v^2 + v * m + 3 * v"), "v*(2*v + m + 3)");
  EXPECT_EQ(simple("2 * exp(v) * exp(m)"), "2*exp(v + m)");
  EXPECT_EQ(simple("v + v * m"), "v + v*m");  // v * (1 + m) would not be smaller
}

TEST(Simplification, ChangesValuesByRoundingAlone) {
  const OperatorSet& operators = find_operator_set("paper+div");
  const Alphabet alphabet{operators, 3};
  RandomStream random(key_of("simplify"));
  Evaluator evaluator;
  int compared = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Expression before = random_formula_of_size(3 + i % 30, alphabet, random);
    const Expression after = simplified(before);
    EXPECT_LE(after.size(), before.size() + 1);
    const std::array<double, 3> point = {random.uniform(0.5, 2), random.uniform(0.5, 2),
                                         random.uniform(0.5, 2)};
    const double value = evaluator.evaluate_at(before, point);
    if (!std::isfinite(value) || std::abs(value) > 1e6) continue;
    // Cancellation magnifies rounding; a real change would be far larger in nearly every case.
    if (std::abs(evaluator.evaluate_at(after, point) - value) <= 1e-9 * (1 + std::abs(value))) {
      ++compared;
    } else {
      ADD_FAILURE() << print(before, kNames) << " became " << print(after, kNames);
    }
  }
  EXPECT_GT(compared, 10'000);
}

TEST(Simplification, HashesStructuresWithoutTheirConstants) {
  EXPECT_EQ(structure_hash(formula("2 * v + m")), structure_hash(formula("m + v * 3")));
  EXPECT_NE(structure_hash(formula("v^2")), structure_hash(formula("v^3")));
  EXPECT_NE(structure_hash(formula("v - m")), structure_hash(formula("m - v")));
}

}  // namespace
}  // namespace tribench::pysr::constraints_test
