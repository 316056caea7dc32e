// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/text.hpp"
#include "problems/catalogue.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using testing::mean_absolute_error;
using testing::run_fit;

const std::vector<std::string> kNames = {"v", "s"};

struct Sample {
  std::vector<double> v;
  std::vector<double> s;
  std::vector<double> y;
  std::vector<const double*> columns;
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -2, 2, {}},
                               {"s", "-", Role::velocity_sign, -1, 1, std::size_t{0}}};
  std::vector<int> movement;
  explicit Sample(const std::string& law) {
    for (int i = -40; i <= 40; ++i) {
      v.push_back(0.05 * i);
      s.push_back(i > 0 ? 1 : i < 0 ? -1 : 0);
    }
    y.resize(v.size());
    movement.assign(v.size(), 0);
    columns = {v.data(), s.data()};
    Evaluator().evaluate(parse(law, kNames), {columns, v.size()}, y);
  }
  TrainingData data() const { return {inputs, columns, y, movement}; }
};

TEST(BranchPolynomial, RecoversCubicsOfBothDirections) {
  const Sample sample("1 + 2*s + v*(3 - 1*s) + v^2*(0.5 + 0.25*s) + v^3*(1 - 2*s)");
  const FitResult result = run_fit(sample.data(), "branch_polynomial");
  EXPECT_LT(mean_absolute_error(result.front.at(0), sample.data(), sample.y), 1e-12);
  EXPECT_TRUE(find_operator_set("paper").admits(result.front[0]));
}

TEST(Placebos, ConstantIsTheMeanAndLinearIsExactOnLines) {
  const Sample sample("2 + 3*v - 4*s");
  const FitResult mean = run_fit(sample.data(), "constant");
  EXPECT_NEAR(mean.front.at(0).node(0).value, 2, 1e-12);
  const FitResult line = run_fit(sample.data(), "linear");
  EXPECT_LT(mean_absolute_error(line.front.at(0), sample.data(), sample.y), 1e-12);
}

TEST(RandomSearch, ReturnsAFrontThatKeepsToItsOperators) {
  const Sample sample("2 + 3*v - 4*s*exp(-v*v)");
  for (const OperatorSet& set : operator_sets()) {
    const FitResult result =
        run_fit(sample.data(), "random_search",
                {.parameters = {{"formulas", std::int64_t{1500}}}, .operators = set.name()});
    ASSERT_FALSE(result.front.empty()) << set.name();
    int last = -1;
    for (const Expression& formula : result.front) {
      EXPECT_TRUE(set.admits(formula)) << set.name() << ": " << print(formula, kNames);
      EXPECT_GT(paper_complexity(formula), last);
      last = paper_complexity(formula);
    }
  }
}

TEST(RandomSearch, SpendsNoMoreThanItsBudget) {
  const Sample sample("v");
  const FitResult result =
      run_fit(sample.data(), "random_search", {.limits = {.evaluations = 100000}});
  EXPECT_EQ(result.reason, StopReason::budget);
}

}  // namespace
}  // namespace tribench
