// SPDX-License-Identifier: MIT
#include "harness/weighted_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
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
