// SPDX-License-Identifier: MIT
#include "harness/weighted_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"x"};
constexpr int kRows = 200;

// Has found a front beforehand, and stands for the last of it.
class FrontMethod : public Regressor {
 public:
  explicit FrontMethod(std::vector<std::string> formulas) : formulas_(std::move(formulas)) {}
  FitResult fit(FitContext& context) const override {
    FitResult result;
    for (const std::string& formula : formulas_) result.front.push_back(parse(formula, kNames));
    result.chosen = result.front.size() - 1;
    EXPECT_TRUE(context.budget.spend(100));
    return result;
  }

 private:
  std::vector<std::string> formulas_;
};

// 3 exp(-x) + 0.7, the more uncertain the smaller x is.
class WeightedFitTest : public ::testing::Test {
 protected:
  WeightedFitTest() {
    problem_.name = "test/decay";
    problem_.dataset = "test";
    problem_.inputs = {{"x", "", Role::none, 0, 4, {}}};
    Table table;
    table.columns.resize(1);
    RandomStream random(5);
    for (int r = 0; r < kRows; ++r) {
      const double x = 4.0 * r / kRows;
      const double sigma = 0.02 + 0.1 * (4 - x);
      table.columns[0].push_back(x);
      table.target.push_back(3 * elementary::exp(-x) + 0.7 + sigma * random.normal());
      table.movement.push_back(r);
      weights_.push_back(1 / (sigma * sigma));
    }
    problem_.stages = {{"fit", {0}, table}};
    task_.cell = {problem_.name, "front", "full", 1};
    task_.operators = find_operator_set("full");
  }
  CellResult fit(std::vector<std::string> front) const {
    return fit_weighted(problem_, weights_, FrontMethod(std::move(front)), task_);
  }

  Problem problem_;
  std::vector<double> weights_;
  CellTask task_;
};

const std::string kLaw = "3*exp(-0.95*x) + 0.69";
const std::string kWiggles =
    "2.9*exp(-0.97*x) + 0.71 + 0.01*sin(7*x)*x^2 - 0.01*cos(11*x) + 0.02*sin(5*x + 1)*exp(-x)";

TEST_F(WeightedFitTest, ChoosesByTheWeightedErrorWhateverTheSearchStoodFor) {
  const CellResult result = fit({"1.2", "2*exp(-0.3*x)", kLaw, kWiggles});
  ASSERT_TRUE(is_ok(result.record));
  EXPECT_EQ(result.record.complexity, 5) << result.record.formula;
}

TEST_F(WeightedFitTest, TellsTheErrorsThatItChoseBy) {
  const CellResult result = fit({"1.2", "2*exp(-0.3*x)", kLaw});
  ASSERT_EQ(result.front.size(), 3U);
  double before = HUGE_VAL;
  for (const FrontRecord& entry : result.front) {
    EXPECT_LT(entry.weighted_rms, before) << entry.formula;
    before = entry.weighted_rms;
  }
}

// A search that hears only of large errors misses what small rows tell, one of sampled rows the
// large ones: each finds a part of the front.
class FrontByRows : public Regressor {
 public:
  FitResult fit(FitContext& context) const override {
    const std::span<const double> x(context.data.columns[0], context.data.rows());
    const bool is_sampled = std::ranges::adjacent_find(x) != x.end();
    FitResult result;
    for (const char* formula : {"1.2", is_sampled ? "2*exp(-0.3*x)" : "3*exp(-0.95*x) + 0.69"}) {
      result.front.push_back(parse(formula, kNames));
    }
    result.chosen = 0;
    EXPECT_TRUE(context.budget.spend(100));
    return result;
  }
};

TEST_F(WeightedFitTest, SearchesTheRowsAsTheyAreToo) {
  const CellResult result = fit_weighted(problem_, weights_, FrontByRows(), task_);
  ASSERT_TRUE(is_ok(result.record));
  EXPECT_EQ(result.record.complexity, 5) << result.record.formula;
  EXPECT_EQ(result.record.evaluations, 200U) << "of both searches";
  EXPECT_EQ(std::ranges::count(result.front, true, &FrontRecord::chosen), 1);
}

// One law and one front, of which the kind of noise decides what is chosen.
class RelativeNoiseFit : public ::testing::Test {
 protected:
  CellResult fit(double relative, double constant) {
    Problem problem;
    problem.name = "test/power";
    problem.dataset = "test";
    problem.inputs = {{"x", "", Role::none, 1, 100, {}}};
    Table table;
    table.columns.resize(1);
    RandomStream random(5);
    for (int r = 0; r < kRows; ++r) {
      const double x = elementary::exp(4.6 * r / kRows);
      table.columns[0].push_back(x);
      const double noise = relative * x * random.normal() + constant * random.normal();
      table.target.push_back(x + noise);
      table.movement.push_back(r);
    }
    problem.stages = {{"fit", {0}, table}};
    problem.test = table;
    CellTask task;
    task.cell = {problem.name, "front", "full", 1};
    task.operators = find_operator_set("full");
    const FrontMethod method({"40", "1.05*x", "1.3*x^0.93 + 0.2*sin(0.3*x) + 1e-30*x^15"});
    CellResult result = fit_and_judge(problem, method, task);
    weights_ = choose_by_relative_noise(problem, task, result);
    return result;
  }
  std::vector<double> weights_;
};

TEST_F(RelativeNoiseFit, IsChosenByRelativeErrorsAndSaysSo) {
  const CellResult result = fit(0.1, 0);
  EXPECT_EQ(weights_.size(), static_cast<std::size_t>(kRows));
  EXPECT_EQ(result.record.complexity, 2) << result.record.formula;
  EXPECT_NE(result.record.note.find("relative errors"), std::string::npos);
}

TEST_F(RelativeNoiseFit, IsLeftAloneWhereNoiseHasOneSize) {
  const CellResult result = fit(0, 3);
  EXPECT_TRUE(weights_.empty());
  EXPECT_EQ(result.record.note.find("relative errors"), std::string::npos);
}

TEST_F(WeightedFitTest, LeavesAProgramItsChoice) {
  task_.method.command = {"true"};
  EXPECT_GT(fit({"1.2", kLaw, kWiggles}).record.complexity, 5);
}

TEST_F(WeightedFitTest, LeavesOutRowsWithoutWeight) {
  for (int r = 0; r < kRows / 2; ++r) {
    weights_[static_cast<std::size_t>(r)] = 0;
    problem_.stages[0].train.target[static_cast<std::size_t>(r)] = 1e3 * r;
  }
  EXPECT_LE(fit({"1.2", "0.9 - 0.1*x", kWiggles}).record.complexity, 5);
}

}  // namespace
}  // namespace tribench
