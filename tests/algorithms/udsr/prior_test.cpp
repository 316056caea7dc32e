// SPDX-License-Identifier: MIT
#include "algorithms/udsr/prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.hpp"
#include "tests/algorithms/udsr/tokens.hpp"

namespace tribench::udsr {
namespace {

class PriorTest : public testing::Test {
 protected:
  TokenId id(std::string_view name) const { return token_id(library, name); }
  Sequence tokens(std::initializer_list<std::string_view> names) const {
    return sequence_of(library, names);
  }
  Prior prior(const PriorOptions& options = {}) const {
    return {library, options, {{-1, 2}, -5, 5}};
  }

  TokenLibrary library{find_operator_set("full"), 2, {.constants = true, .linear = true}};
};

TEST_F(PriorTest, KeepsLengthWithinItsLimits) {
  PriorOptions options;
  options.max_length = 6;
  EXPECT_FALSE(prior(options).allows(tokens({"+", "x1", "x2"})));
  EXPECT_TRUE(prior(options).allows(tokens({"+", "x1", "tanh", "x2"})));
  EXPECT_TRUE(prior(options).allows(tokens({"+", "x1", "*", "x1", "tanh", "x2"})));
  EXPECT_FALSE(prior(options).allows(tokens({"+", "x1", "*", "x1", "+", "x1", "x2"})));
}

TEST_F(PriorTest, ForbidsInversesNestedTrigonometryAndIdleConstants) {
  EXPECT_FALSE(prior().allows(tokens({"+", "x1", "exp", "log", "x2"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "x1", "sin", "*", "x1", "cos", "x2"})));
  EXPECT_TRUE(prior().allows(tokens({"+", "sin", "x1", "cos", "x2"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "x1", "exp", "const"})));
  EXPECT_FALSE(prior().allows(tokens({"*", "x1", "+", "const", "const"})));
  EXPECT_TRUE(prior().allows(tokens({"*", "x1", "+", "const", "x2"})));
}

TEST_F(PriorTest, AllowsThreeConstantsAndNoFormulaWithoutAnInput) {
  EXPECT_TRUE(prior().allows(
      tokens({"+", "*", "const", "x1", "+", "*", "const", "x2", "*", "const", "tanh", "x1"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "const", "+", "*", "const", "x1", "+", "*", "const",
                                      "x2", "*", "const", "tanh", "x1"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "const", "tanh", "tanh", "const"})));
}

TEST_F(PriorTest, AllowsOneLinearTokenUnderInvertibleFunctionsAndNoConstantBesideIt) {
  EXPECT_TRUE(prior().allows(tokens({"linear"})));
  EXPECT_TRUE(prior().allows(tokens({"*", "linear", "exp", "x1"})));
  EXPECT_FALSE(prior().allows(tokens({"*", "linear", "exp", "linear"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "x1", "sin", "linear"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "x1", "abs", "*", "x2", "linear"})));
  EXPECT_FALSE(prior().allows(tokens({"+", "linear", "*", "const", "x1"})));
}

TEST_F(PriorTest, KnowsTheRangesOfTheData) {
  EXPECT_FALSE(prior().allows(tokens({"exp", "+", "x1", "x2"})));  // the target is negative
  EXPECT_FALSE(prior().allows(tokens({"+", "x2", "sqrt", "x1"})));
  EXPECT_TRUE(prior().allows(tokens({"+", "x1", "sqrt", "x2"})));
  EXPECT_TRUE(prior().allows(tokens({"+", "x2", "sqrt", "*", "x1", "x1"})));
}

TEST_F(PriorTest, AppliesEveryRelation) {
  const TokenSet minus = set_of(id("-"));
  struct Case {
    Relation relation;
    TokenSet effectors;
    Sequence broken;  // has x1 in the relation
    Sequence kept;
  };
  const std::vector<Case> cases = {
      {Relation::left_child, minus, tokens({"-", "x1", "tanh", "x2"}),
       tokens({"-", "tanh", "x2", "x1"})},
      {Relation::right_child, minus, tokens({"-", "tanh", "x2", "x1"}),
       tokens({"-", "x1", "tanh", "x2"})},
      {Relation::child, minus, tokens({"-", "x1", "tanh", "x2"}),
       tokens({"-", "tanh", "x1", "x2"})},
      {Relation::only_child, set_of(id("tanh")), tokens({"-", "tanh", "x1", "x2"}),
       tokens({"-", "tanh", "x2", "x1"})},
      {Relation::sibling, set_of(id("x2")), tokens({"*", "x2", "-", "x2", "x1"}),
       tokens({"*", "x2", "-", "x1", "x2"})},
      {Relation::descendant, set_of(id("tanh")), tokens({"+", "x2", "tanh", "-", "x2", "x1"}),
       tokens({"-", "tanh", "x2", "x1"})},
  };
  PriorOptions options;
  options.domain_range = false;
  for (const Case& c : cases) {
    Prior rules = prior(options);
    EXPECT_TRUE(rules.allows(c.broken));
    rules.add_constraint({c.relation, set_of(id("x1")), c.effectors});
    EXPECT_FALSE(rules.allows(c.broken));
    EXPECT_TRUE(rules.allows(c.kept));
  }
}

TEST_F(PriorTest, ShiftsLogitsByArityAndLength) {
  PriorOptions options;
  options.domain_range = false;
  const Prior rules = prior(options);
  std::vector<double> logits(library.size(), 0.0);
  rules.add_to(Traversal(library), logits);
  // At the first place an input would end the formula too early; nothing discourages operations.
  EXPECT_EQ(logits[id("x1")], kForbidden);
  EXPECT_DOUBLE_EQ(logits[id("+")], -std::log(4.0));    // + - * /
  EXPECT_DOUBLE_EQ(logits[id("exp")], -std::log(8.0));  // exp log sqrt abs sin cos tanh atan
  EXPECT_DOUBLE_EQ(logits[id("linear")], -std::log(4.0));
  // After a dozen tokens operations are discouraged: -(12 - 10)^2 / (2 * 5).
  Traversal late(library);
  for (int i = 0; i < 6; ++i) {
    late.push(id("+"));
    late.push(id("x1"));
  }
  std::ranges::fill(logits, 0.0);
  rules.add_to(late, logits);
  EXPECT_DOUBLE_EQ(logits[id("+")], -std::log(4.0) - 0.4);
  EXPECT_DOUBLE_EQ(logits[id("x1")], -std::log(4.0));
}

TEST_F(PriorTest, NeverLeavesThePolicyWithoutAToken) {
  PriorOptions options;
  options.max_length = 7;
  const Prior rules = prior(options);
  RandomStream random(3);
  for (int k = 0; k < 5000; ++k) {
    Traversal traversal(library);
    while (!traversal.complete()) {
      std::vector<double> logits(library.size(), 0.0);
      rules.add_to(traversal, logits);
      std::vector<TokenId> possible;
      for (std::size_t i = 0; i < logits.size(); ++i) {
        if (logits[i] > kForbidden) possible.push_back(static_cast<TokenId>(i));
      }
      ASSERT_FALSE(possible.empty());
      traversal.push(possible[random.below(possible.size())]);
    }
    ASSERT_LE(traversal.length(), 7);
  }
}

}  // namespace
}  // namespace tribench::udsr
