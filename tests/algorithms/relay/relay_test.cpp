// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"
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

// Snell's law, a bead on a turning hoop, a heading, a lag; without the operation as before.
TEST(Relay, FindsWhatAnAngleIsTheSineCosineOrTangentOf) {
  const DrawnLaw laws[] = {
      {"asin(n*sin(t)/m)", {{"n", 1, 1.4}, {"t", 0.1, 1.2}, {"m", 1.4, 2.4}}, 200},
      {"acos(g/(w^2*r))", {{"g", 1, 5}, {"w", 3, 6}, {"r", 0.7, 2}}, 200},
      {"atan(y/x)", {{"x", 0.5, 4}, {"y", -3, 3}}, 200},
      {"0.7 - 1.3*atan(2.5*w)", {{"w", -3, 3}}, 200},
  };
  for (const DrawnLaw& law : laws) {
    const FitResult result = run_fit(law.data(), "relay", with_evaluations(300'000'000));
    EXPECT_LT(law.error_of(result.front[result.chosen]), 1e-9)
        << print(result.front[result.chosen], law.names);
    EXPECT_THAT(result.note, ::testing::HasSubstr("explained by fewer variables"));
  }
  FitOptions koza = with_evaluations(30'000'000);
  koza.operators = "koza";
  for (const Expression& formula : run_fit(laws[2].data(), "relay", koza).front) {
    EXPECT_EQ(std::ranges::count(formula.nodes(), Op::atan, &Node::op), 0);
  }
}

// Sums of a dozen terms explain these rows, or come as near as 1e-12, long before the law is found.
TEST(Relay, LooksForAShorterFormOfWhatALongOneExplains) {
  const std::vector<testing::DrawnInput> two = {{"x", 0.1, 10}, {"q", 0.1, 10}};
  const std::vector<testing::DrawnInput> three = {{"x", 0.1, 10}, {"q", 0.1, 10}, {"z", 0.1, 10}};
  const DrawnLaw laws[] = {{"(x - 1)^2*(q - 2)", two, 100},
                           {"2*x^-0.5 - 3*q^2", two, 100},
                           {"7.7*sqrt(x) + 2.5*q + 4", two, 100},
                           {"5.1*x^0.75 + 2.5*q", two, 100},
                           {"sin(x + q)", two, 100},
                           {"sqrt(x*q) + 2*z + 1", three, 100}};
  for (const DrawnLaw& law : laws) {
    FitOptions options = with_evaluations(8'000'000'000);
    const FitResult result = run_fit(law.data(), "relay", options);
    const Expression& chosen = result.front[result.chosen];
    EXPECT_LT(law.error_of(chosen), 1e-13) << print(chosen, law.names);
    EXPECT_LE(chosen.size(), 13U) << print(chosen, law.names) << ": " << result.note;
  }
}

TEST(Relay, StaysWithItsMembersWhereNoStructureIsExact) {
  const DrawnLaw law("2*x + 0.5", {{"x", -1, 1}}, 60, 0.05);
  const FitResult result = run_fit(law.data(), "relay", with_evaluations(30'000'000));
  ASSERT_FALSE(result.front.empty());
  EXPECT_LT(law.error_of(result.front[result.chosen]), 0.06);
  EXPECT_EQ(result.note, "");
}

// udsr has not so many tokens, and what the others find was lost with it.
TEST(Relay, LeavesOutAMemberThatCannotDoSoManyInputs) {
  std::vector<testing::DrawnInput> inputs;
  for (int j = 0; j < 70; ++j) inputs.push_back({"x" + std::to_string(j), 1, 2});
  const DrawnLaw law("2*x3 + sin(5*x7)*x8", inputs, 90, 0.05);
  const FitResult result = run_fit(law.data(), "relay", with_evaluations(3'000'000));
  EXPECT_FALSE(result.front.empty());
  EXPECT_THAT(result.note, ::testing::HasSubstr("udsr: "));
}

// Every part can be left out, and what it alone finds is then found by another or not at all.
TEST(Relay, DoesWithoutAnyOfItsParts) {
  const DrawnLaw law("2.5*x^2/y", {{"x", 1, 3}, {"y", 1, 3}}, 60);
  for (const char* part : {"nothing", "products", "sums", "collapses", "reductions", "parts",
                           "guesses", "wide_sums", "pysr", "udsr", "parfam"}) {
    FitOptions options = with_evaluations(30'000'000);
    options.parameters["without"] = std::string(part);
    const FitResult result = run_fit(law.data(), "relay", options);
    EXPECT_LT(law.error_of(result.front[result.chosen]), 1e-9) << part;
    const bool by_product = result.note == "explained by a product of powers";
    EXPECT_EQ(by_product, part != std::string("products")) << part << ": " << result.note;
  }
}

// The searches for structure may take all of the time: a formula there is all the same.
TEST(Relay, AnswersWhenTheClockHasRunOutBeforeItsMembers) {
  const DrawnLaw law("2*x + 0.5", {{"x", -1, 1}}, 60, 0.05);
  FitOptions options;
  options.limits.cpu_seconds = 0;
  for (const char* name : {"pysr", "relay"}) {
    EXPECT_EQ(run_fit(law.data(), name, options).front.size(), 1U) << name;
  }
}

// Listing what is likely under noise once took the whole of its part of the seconds, and nothing
// of it was looked at.
TEST(Relay, TellsALawUnderNoiseWithinASecond) {
  const DrawnLaw law("a*b*c/(b + c)", {{"a", 1, 5}, {"b", 1, 100}, {"c", 1, 100}}, 256, 0.01);
  FitOptions options = with_evaluations(4'000'000'000);
  options.limits.cpu_seconds = 1;
  const FitResult result = run_fit(law.data(), "relay", options);
  EXPECT_LT(result.front[result.chosen].size(), 16U)
      << print(result.front[result.chosen], law.names);
  const DrawnLaw exact("a*b*c/(b + c)", {{"a", 1, 5}, {"b", 1, 100}, {"c", 1, 100}}, 256, 0, 2);
  EXPECT_LT(exact.error_of(result.front[result.chosen]), 3e-3);
}

// A method is not begun when it could hardly prepare its rows: udsr took a seventh of a second
// more. The least of three: what else the machine does only adds.
TEST(Relay, HoldsItsSeconds) {
  const DrawnLaw law("n*t/(v - n*b) - a*n^2/v^2 + 0.1*sin(t*v)",
                     {{"n", 1, 3}, {"t", 1, 3}, {"v", 4, 9}, {"b", 0.1, 1}, {"a", 1, 3}}, 256,
                     0.01);
  FitOptions options = with_evaluations(4'000'000'000);
  options.limits.cpu_seconds = 0.5;
  const double bound = 1.2 * options.limits.cpu_seconds;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3 && least >= bound; ++round) {
    const double begin = process_cpu_seconds();
    run_fit(law.data(), "relay", options);
    least = std::min(least, process_cpu_seconds() - begin);
  }
  EXPECT_LT(least, bound);
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

// A power of an input that no double holds leaves no rows to look at.
TEST(Relay, LeavesOutAVariableThatOverflows) {
  RandomStream random(2);
  std::vector<std::vector<double>> columns(4);
  std::vector<double> target;
  std::vector<int> movement;
  for (int r = 0; r < 120; ++r) {
    const double x = random.uniform(280, 600);
    const double log_c = random.uniform(-2.3, 2.3);
    columns[0].push_back(elementary::exp(log_c));
    columns[1].push_back(elementary::log(x));
    columns[2].push_back(log_c);
    columns[3].push_back(x);
    target.push_back(5 + log_c - 5000 / x + 0.03 * random.normal());
    movement.push_back(r);
  }
  const std::vector<Input> inputs = {{"c", "", Role::none, 0.1, 10, {}},
                                     {"log_x", "", Role::none, 5.6, 6.4, {}},
                                     {"log_c", "", Role::none, -2.3, 2.3, {}},
                                     {"x", "", Role::none, 280, 600, {}}};
  std::vector<const double*> pointers;
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
  const FitResult result =
      run_fit({inputs, pointers, target, movement}, "relay", with_evaluations(30'000'000));
  EXPECT_FALSE(result.front.empty());
}

}  // namespace
}  // namespace tribench
