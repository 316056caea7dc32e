// SPDX-License-Identifier: MIT
#include "algorithms/relay/long_sum.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "foundation/random.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::DrawnInput;
using testing::DrawnLaw;

constexpr std::size_t kRows = 4000;

std::optional<relay::LongSum> sum_of(const DrawnLaw& law, const std::string& operators = "full") {
  const FiniteRows rows(law.data());
  Budget budget({});
  return relay::fit_long_sum(rows, find_operator_set(operators), kRows, budget);
}

double mean_square(const DrawnLaw& law) {
  double sum = 0;
  for (const double y : law.target) sum += y * y / static_cast<double>(law.target.size());
  return sum;
}

const std::vector<DrawnInput> kThree = {{"a", -2, 2}, {"b", -2, 2}, {"c", -2, 2}};
const std::string kBent = "abs(a - 0.3)*b + 0.5*abs(b + 1)*abs(c) + 0.2*a*b*c";

TEST(LongSum, FollowsAKinkedTableAndSaysHowWell) {
  const DrawnLaw law(kBent, kThree, 600, 0.05);
  const auto sum = sum_of(law);
  ASSERT_TRUE(sum);
  EXPECT_LT(sum->mean_held_out(), 0.05 * mean_square(law));
  const DrawnLaw unseen(kBent, kThree, 600, 0.05, 2);
  const double error = unseen.error_of(sum->formula);
  EXPECT_NEAR(error * error * mean_square(unseen), sum->mean_held_out(), 0.3 * sum->mean_held_out())
      << "as honest as rows that nobody had";
}

TEST(LongSum, DoesWithWhatTheOperatorsHave) {
  const DrawnLaw law(kBent, kThree, 600, 0.05);
  const auto straight = sum_of(law, "paper");
  ASSERT_TRUE(straight);
  EXPECT_TRUE(find_operator_set("paper").admits(straight->formula));
  EXPECT_GT(straight->mean_held_out(), sum_of(law)->mean_held_out());
}

TEST(LongSum, SaysMoreTheMoreRowsItIsChosenOn) {
  // Fifty-six terms of no great size, in noise: 400 rows tell some of them.
  const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f"};
  std::vector<DrawnInput> inputs;
  for (const std::string& name : names) inputs.push_back({name, -2, 2});
  std::string text = "0";
  RandomStream random(5);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i; j < names.size(); ++j) {
      for (std::size_t k = j; k < names.size(); ++k) {
        text += fmt::format(" + {:.3f}*{}*{}*{}", random.normal(), names[i], names[j], names[k]);
      }
    }
  }
  const DrawnLaw law(text, inputs, 6000, 0.3);
  const DrawnLaw unseen(text, inputs, 1000, 0.0, 2);
  const FiniteRows rows(law.data());
  Budget budget({});
  const auto few = relay::fit_long_sum(rows, find_operator_set("full"), 400, budget);
  const auto many = relay::fit_long_sum(rows, find_operator_set("full"), 6000, budget);
  ASSERT_TRUE(few && many);
  EXPECT_LT(unseen.error_of(many->formula), 0.06) << "0.3 sqrt(56 / 6000) is 0.03";
  EXPECT_GT(unseen.error_of(few->formula), 2 * unseen.error_of(many->formula));
}

TEST(LongSum, IsNotBegunWhereTheSecondsAreOver) {
  const DrawnLaw law(kBent, kThree, 600, 0.05);
  const FiniteRows rows(law.data());
  BudgetLimits limits;
  limits.cpu_seconds = 0;
  Budget budget(limits);
  EXPECT_FALSE(relay::fit_long_sum(rows, find_operator_set("full"), kRows, budget));
}

TEST(LongSum, TakesFewOfFiftyInputs) {
  std::vector<DrawnInput> inputs;
  for (int j = 0; j < 50; ++j) inputs.push_back({"x" + std::to_string(j), -1, 1});
  const std::string text = "x7 + 2*x11^2 + 2*x20*x20*x20 + x7*x41 + x41";
  const auto sum = sum_of(DrawnLaw(text, inputs, 400, 0.05));
  ASSERT_TRUE(sum);
  EXPECT_LT(DrawnLaw(text, inputs, 400, 0.0, 2).error_of(sum->formula), 0.1);
}

// What is small in the user's unit is no smaller for that.
TEST(LongSum, IsTheSameInOtherUnits) {
  const std::vector<DrawnInput> inputs = {{"a", 1e-9, 4e-9}, {"b", 1e6, 5e6}};
  const DrawnLaw law("a*b + 3e3*a*a*b + 1e-17*b^2", inputs, 300);
  const auto sum = sum_of(law);
  ASSERT_TRUE(sum);
  EXPECT_LT(law.error_of(sum->formula), 1e-6) << print(sum->formula, law.names);
}

TEST(LongSum, SaysNothingOfNoiseAndOfFewRows) {
  const DrawnLaw noise("1 + 0*a", {{"a", -1, 1}, {"b", -1, 1}}, 300, 1.0);
  const auto sum = sum_of(noise);
  if (sum) {
    const double mean = 1;
    EXPECT_GT(sum->mean_held_out(), 0.9 * (mean_square(noise) - mean));
  }
  EXPECT_FALSE(sum_of(DrawnLaw(kBent, kThree, 39)));
}

// A table of no law: relay prints the sum where it stands better than what was searched for.
TEST(LongSum, StandsForRelayWhereItIsNearerToRowsHeldOut) {
  const DrawnLaw law(kBent + " + abs(c - 1)*a - 0.7*abs(a + 1)*abs(b - 0.5)", kThree, 500, 0.05);
  testing::FitOptions options;
  options.operators = "full";
  options.limits.evaluations = 30'000'000;
  const FitResult with = testing::run_fit(law.data(), "relay", options);
  options.parameters["without"] = std::string("long_sums");
  const FitResult without = testing::run_fit(law.data(), "relay", options);
  EXPECT_LT(law.error_of(with.front[with.chosen]),
            0.7 * law.error_of(without.front[without.chosen]));
}

}  // namespace
}  // namespace tribench
