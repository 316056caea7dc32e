// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/algorithms/relay/drawn_law.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::DrawnLaw;
using testing::FitOptions;
using testing::run_fit;

FitOptions with_evaluations(std::uint64_t evaluations) {
  FitOptions options;
  options.operators = "full";
  options.limits.evaluations = evaluations;
  return options;
}

// Planck's law in the units of its constants, over all of its inputs.
TEST(Relay, FindsALawOfManyInputsByFewerVariables) {
  const DrawnLaw law("a*v^3/(exp(4.8e-11*v/t) - 1)",
                     {{"a", 1, 100, true}, {"v", 1e12, 1e15, true}, {"t", 100, 10000, true}}, 400);
  const FitResult result = run_fit(law.data(), "relay", with_evaluations(1'000'000'000));
  EXPECT_LT(law.error_of(result.front[result.chosen]), 1e-6)
      << print(result.front[result.chosen], law.names);
  EXPECT_THAT(result.note, ::testing::HasSubstr("explained by fewer variables"));
}

TEST(Relay, StaysWithItsMembersWhereNoStructureIsExact) {
  const DrawnLaw law("2*x + 0.5", {{"x", -1, 1}}, 60, 0.05);
  const FitResult result = run_fit(law.data(), "relay", with_evaluations(30'000'000));
  ASSERT_FALSE(result.front.empty());
  EXPECT_LT(law.error_of(result.front[result.chosen]), 0.06);
  EXPECT_EQ(result.note, "");
}

// Hundreds of pairs are left alone: what is looked for is still found, within memory and time.
TEST(Relay, TakesDozensOfInputs) {
  std::vector<testing::DrawnInput> inputs;
  for (int j = 0; j < 40; ++j) inputs.push_back({"x" + std::to_string(j), 1, 3});
  const DrawnLaw product("2.5*x3^2/x31", inputs, 120);
  const FitResult found = run_fit(product.data(), "relay", with_evaluations(100'000'000));
  EXPECT_LT(product.error_of(found.front[found.chosen]), 1e-9);
  const DrawnLaw sum("2.5*x3^2/x31 + exp(x7)", inputs, 120, 0.1);
  EXPECT_FALSE(run_fit(sum.data(), "relay", with_evaluations(100'000'000)).front.empty());
}

}  // namespace
}  // namespace tribench
