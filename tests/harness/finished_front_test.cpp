// SPDX-License-Identifier: MIT
#include "harness/finished_front.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// Two thirds of a line's rows are noise, and the front holds one formula that follows the noise.
FitResult finished_on_few_rows(bool yields, double seconds = 1e6) {
  const std::vector<std::string> names = {"v"};
  std::vector<double> v;
  std::vector<double> target;
  RandomStream random(7);
  for (int r = 0; r < 30; ++r) {
    v.push_back(random.uniform(-1, 1));
    target.push_back(2 * v.back() + random.normal());
  }
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, std::nullopt}};
  const std::vector<const double*> columns = {v.data()};
  const TrainingData data{inputs, columns, target, {}};
  FitResult fit;
  fit.front = {parse("0.3 + 2*v + 3*v^3 + 5*v^5 + 7*v^7 + 9*v^9 + 11*v^11 + 4*sin(9*v)", names)};
  fit.yields_to_plain_sum = yields;
  Budget budget({1'000'000, seconds});
  finish_front(data, find_operator_set("full"), budget, fit);
  return fit;
}

TEST(FinishedFront, PutsNoFormulaUnderTheNameOfAMethodThatNeverOfferedIt) {
  EXPECT_EQ(finished_on_few_rows(false).front.size(), 1U);
}

TEST(FinishedFront, TakesAPlainSumOnFewRowsWhereTheMethodYieldsToIt) {
  const FitResult fit = finished_on_few_rows(true);
  ASSERT_EQ(fit.front.size(), 2U);
  EXPECT_EQ(fit.chosen, 0U);
  EXPECT_LT(fit.front[0].size(), 8U) << print(fit.front[0], std::vector<std::string>{"v"});
}

// Through ten rows of a line with noise a wave of ten numbers goes exactly.
TEST(FinishedFront, ChoosesNoFormulaThatHasANumberForEveryOtherRow) {
  constexpr Eigen::Index kRows = 10;
  const std::vector<std::string> names = {"x"};
  std::vector<double> x;
  std::vector<double> target;
  RandomStream random(3);
  for (Eigen::Index r = 0; r < kRows; ++r) {
    x.push_back(0.3 * static_cast<double>(r));
    target.push_back(2 * x.back() + 0.01 * random.normal());
  }
  // Waves of 1.5 a unit and less, and a line.
  Eigen::MatrixXd waves(kRows, kRows);
  const auto wave = [](Eigen::Index k, double at) {
    return k == 0 ? at : k == 1 ? 1.0 : std::sin(static_cast<double>(k) * at);
  };
  for (Eigen::Index r = 0; r < kRows; ++r) {
    for (Eigen::Index k = 0; k < kRows; ++k) waves(r, k) = wave(k, x[static_cast<std::size_t>(r)]);
  }
  const Eigen::VectorXd size =
      waves.fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(target.data(), kRows));
  std::string exact = fmt::format("{}*x + {}", size(0), size(1));
  for (Eigen::Index k = 2; k < kRows; ++k) exact += fmt::format(" + {}*sin({}*x)", size(k), k);
  const std::vector<Input> inputs = {{"x", "-", Role::none, 0, 3, std::nullopt}};
  const std::vector<const double*> columns = {x.data()};
  FitResult fit;
  fit.front = {parse("3", names), parse("2*x", names), parse(exact, names)};
  fit.chosen = 2;
  Budget budget({1'000'000, 1e6});
  finish_front({inputs, columns, target, {}}, find_operator_set("full"), budget, fit);
  EXPECT_EQ(fit.chosen, 1U) << print(fit.front[fit.chosen], names);
  EXPECT_NE(fit.note.find("a number for every other row"), std::string::npos) << fit.note;
}

// y falls with x; a power of both is large where one is and the other is not, which is in no row.
TEST(FinishedFront, HasNoFormulaThatIsFarAwayBetweenTheRows) {
  const std::vector<std::string> names = {"x", "y"};
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> target;
  RandomStream random(3);
  for (int r = 0; r < 500; ++r) {
    x.push_back(random.uniform(1, 2));
    y.push_back(3 - x.back());
    target.push_back(x.back() + 0.1 * random.normal());
  }
  const std::vector<Input> inputs = {{"x", "-", Role::none, 1, 2, std::nullopt},
                                     {"y", "-", Role::none, 1, 2, std::nullopt}};
  const std::vector<const double*> columns = {x.data(), y.data()};
  FitResult fit;
  for (const char* formula : {"1.5", "x", "x + 1e-9*x^40", "x + 1e-16*x^60*y^30"}) {
    fit.front.push_back(parse(formula, names));
  }
  fit.chosen = 3;
  Budget budget({1'000'000, 1e6});
  finish_front({inputs, columns, target, {}}, find_operator_set("full"), budget, fit);
  ASSERT_EQ(fit.front.size(), 2U);
  EXPECT_EQ(print(fit.front[fit.chosen], names), "x");
  EXPECT_NE(fit.note.find("ten times the target's range"), std::string::npos);
}

// A product over decades is a hundred times the target's range where all its factors are large at
// once, which is in no row; and nothing simpler comes near.
TEST(FinishedFront, KeepsALawThatIsFarAwayBetweenTheRowsWhereNothingElseFits) {
  const std::vector<std::string> names = {"x", "y"};
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> target;
  RandomStream random(3);
  for (int r = 0; r < 300; ++r) {
    const double share = random.uniform(0, 1);
    x.push_back(1 + 99 * share * share);
    y.push_back(1 + 99 * (1 - share) * (1 - share));
    target.push_back(x.back() * y.back() / 100 * (1 + 0.1 * random.normal()));
  }
  const std::vector<Input> inputs = {{"x", "-", Role::none, 1, 100, std::nullopt},
                                     {"y", "-", Role::none, 1, 100, std::nullopt}};
  const std::vector<const double*> columns = {x.data(), y.data()};
  FitResult fit;
  for (const char* formula : {"2.5", "0.05*x", "0.01*x*y", "0.01*x*y + 1e-60*x^30*y^10"}) {
    fit.front.push_back(parse(formula, names));
  }
  fit.chosen = 2;
  Budget budget({1'000'000, 1e6});
  finish_front({inputs, columns, target, {}}, find_operator_set("full"), budget, fit);
  ASSERT_EQ(fit.front.size(), 3U) << "what fits one row more goes";
  EXPECT_EQ(fit.note, "");
  EXPECT_EQ(fit.chosen, 2U);
}

// In double precision the second is a staircase, on which some of the noise rests.
TEST(FinishedFront, HasNoFormulaWhoseValueIsLostInRounding) {
  const std::vector<std::string> names = {"x"};
  std::vector<double> x;
  std::vector<double> target;
  RandomStream random(3);
  for (int r = 0; r < 500; ++r) {
    x.push_back(random.uniform(1, 2));
    target.push_back(x.back() + 0.1 * random.normal());
  }
  const std::vector<Input> inputs = {{"x", "-", Role::none, 1, 2, std::nullopt}};
  const std::vector<const double*> columns = {x.data()};
  FitResult fit;
  fit.front = {parse("x", names), parse("1.03e13*(x + 1e-13*x - abs(x)) - 0.02*x^2", names)};
  fit.chosen = 1;
  Budget budget({1'000'000, 1e6});
  finish_front({inputs, columns, target, {}}, find_operator_set("full"), budget, fit);
  EXPECT_EQ(print(fit.front[fit.chosen], names), "x");
}

// The front of a method that keeps its choice, the second, on 30 rows of slope*v and noise.
FitResult finished_by_one_that_keeps(double slope, double noise,
                                     const std::vector<std::string>& formulas) {
  const std::vector<std::string> names = {"v"};
  std::vector<double> v;
  std::vector<double> target;
  RandomStream random(7);
  for (int r = 0; r < 30; ++r) {
    v.push_back(0.1 * r);
    target.push_back(slope * v.back() + noise * random.normal());
  }
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, 0, 3, std::nullopt}};
  const std::vector<const double*> columns = {v.data()};
  const TrainingData data{inputs, columns, target, {}};
  FitResult fit;
  for (const std::string& formula : formulas) fit.front.push_back(parse(formula, names));
  fit.chosen = 1;
  fit.keeps_choice = true;
  Budget budget({1'000'000, 1e6});
  finish_front(data, find_operator_set("full"), budget, fit);
  return fit;
}

// The shorter formula is exact, and the folds speak for it too.
TEST(FinishedFront, LeavesTheChoiceOfAMethodThatKeepsIt) {
  const FitResult fit = finished_by_one_that_keeps(2, 0, {"2*v", "0.7 + 0.37*v^2"});
  EXPECT_EQ(print(fit.front[fit.chosen], std::vector<std::string>{"v"}), "0.7 + 0.37*v^2");
}

// Shortened, the second is the shorter of the two; it stays the chosen one.
TEST(FinishedFront, StandsByComplexityAlsoWhereALongFormulaBecomesAShortOne) {
  const FitResult fit =
      finished_by_one_that_keeps(2.17, 0.1, {"0.7131 + 0.3717*v^2", "2.1713*v + sin(v) - sin(v)"});
  ASSERT_EQ(fit.front.size(), 2U);
  EXPECT_LT(paper_complexity(fit.front[0]), paper_complexity(fit.front[1]));
  EXPECT_EQ(fit.chosen, 0U);
}

// Seconds of folds were spent beyond those that a fit was given.
TEST(FinishedFront, LeavesTheChoiceOnceTheSecondsHaveRunOut) {
  EXPECT_EQ(finished_on_few_rows(true, 0).front.size(), 1U);
}

}  // namespace
}  // namespace tribench
