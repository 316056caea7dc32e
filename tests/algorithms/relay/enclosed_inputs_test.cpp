// SPDX-License-Identifier: MIT
#include "algorithms/relay/enclosed_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench::relay::enclosed_inputs_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::string> kNames = {"a", "b", "c"};

std::vector<std::string> inputs_of(const std::string& formula) {
  const auto reduction = enclosed_inputs(parse(formula, kNames), kNames.size());
  std::vector<std::string> texts;
  if (!reduction) return texts;
  for (const Expression& input : reduction->inputs) texts.push_back(print(input, kNames));
  return texts;
}

TEST(EnclosedInputs, AreThoseThatAFormulaReadsTogetherAlone) {
  EXPECT_THAT(inputs_of("log(a*b + 1) + c"), ElementsAre("a*b", "c"));
  EXPECT_THAT(inputs_of("c*tanh(sqrt(a + 2*b))"), ElementsAre("a + 2*b", "c"));
}

TEST(EnclosedInputs, AreFoundInProductsHoweverTheyAreWritten) {
  EXPECT_THAT(inputs_of("1.3*a*b*exp(-0.003*b*a)/(a^2*b^2 + c)"), ElementsAre("a*b", "c"));
  EXPECT_THAT(inputs_of("c + sqrt(a/b)/(2*b/a + 1)"), ElementsAre("a/b", "c"));
}

TEST(EnclosedInputs, LeaveOutWhatTheFormulaDoesNotRead) {
  EXPECT_THAT(inputs_of("exp(a)/(exp(a) + b + a)"), ElementsAre("a", "b"));
}

TEST(EnclosedInputs, AreNoneWhereEveryInputIsReadByItself) {
  EXPECT_THAT(inputs_of("a*b + b*c + c*a"), IsEmpty());
  EXPECT_THAT(inputs_of("2.5"), IsEmpty());
}

}  // namespace
}  // namespace tribench::relay::enclosed_inputs_test
