// SPDX-License-Identifier: MIT
#include "algorithms/relay/part_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::DrawnInput;
using testing::DrawnLaw;
using ::testing::ElementsAre;
using testing::FitOptions;
using ::testing::HasSubstr;
using testing::run_fit;

std::optional<relay::Separation> separation_of(const DrawnLaw& law) {
  const FiniteRows finite(law.data());
  Budget budget({});
  return relay::find_separation(relay::LogRows(finite, 512), budget);
}

const std::vector<DrawnInput> kFour = {{"a", 0.5, 3}, {"b", -2, 2}, {"c", -3, 3}, {"d", -2, 2}};

TEST(Separation, FindsTheInputsOfEachTermOfASum) {
  const auto parts = separation_of({"b*sqrt(a) - 0.7*exp(0.4*d)*c", kFour, 300});
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->form, relay::TargetForm::plain);
  EXPECT_THAT(parts->parts, ElementsAre(ElementsAre(0, 1), ElementsAre(2, 3)));
}

// So many inputs that a polynomial in all of them has no degree to tell the pairs by.
TEST(Separation, FindsTheInputsOfEachTermOfALongSum) {
  const auto parts = separation_of(
      {"x - y + z*w + u*sin(1.6*v)",
       {{"x", -3, 3}, {"y", -3, 3}, {"z", -3, 3}, {"w", -3, 3}, {"v", -3, 3}, {"u", -3, 3}},
       300});
  ASSERT_TRUE(parts);
  EXPECT_THAT(parts->parts,
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(2, 3), ElementsAre(4, 5)));
}

TEST(Separation, FindsTheInputsOfEachFactorOfAProduct) {
  const auto parts = separation_of({"(2 + cos(b))/(1 + exp(1.3*c))", kFour, 300});
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->form, relay::TargetForm::logarithm);
  // An input that says nothing is a part of its own.
  EXPECT_THAT(parts->parts, ::testing::Contains(ElementsAre(1)));
  EXPECT_THAT(parts->parts, ::testing::Contains(ElementsAre(2)));
}

// Where parts share an input, a power is divided out elsewhere, or there is nothing but noise.
TEST(Separation, IsNoneWhereThereAreNoParts) {
  for (const std::string text : {"a*b + b*c + c*d", "a*(b + c*d)^2", "sin(a + b + c*d)"}) {
    EXPECT_FALSE(separation_of({text, kFour, 300})) << text;
  }
  EXPECT_FALSE(separation_of({"a + b", kFour, 300, 10}));
}

TEST(Relay, FindsASumOfPartsWithConstantsOfTheirOwn) {
  const DrawnLaw law("b*exp(-1.3*a) + 2.1*sin(0.8*c)*d + 0.4", kFour, 300);
  FitOptions options;
  options.operators = "full";
  options.limits.evaluations = 3'000'000'000;
  const FitResult result = run_fit(law.data(), "relay", options);
  EXPECT_LT(law.error_of(result.front[result.chosen]), 1e-9)
      << print(result.front[result.chosen], law.names);
  EXPECT_THAT(result.note, HasSubstr("explained by parts"));
}

}  // namespace
}  // namespace tribench
