// SPDX-License-Identifier: MIT
#include "algorithms/pysr/feature_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr::feature_selection_test {
namespace {

constexpr std::size_t kInputs = 8;

// 5 x_2 + exp(x_6) + x_4 / 2, noise 0.1; the other five inputs do nothing.
Rows mixture(std::size_t count) {
  RandomStream random(key_of("mixture"));
  std::vector<std::vector<double>> columns(kInputs);
  std::vector<double> target;
  for (std::size_t r = 0; r < count; ++r) {
    for (auto& column : columns) column.push_back(random.uniform(-1.5, 1.5));
    target.push_back(5 * columns[2][r] + std::exp(columns[6][r]) + columns[4][r] / 2 +
                     0.1 * random.normal());
  }
  return {std::move(columns), std::move(target)};
}

TEST(FeatureSelection, RanksWhatMattersFirst) {
  const Rows rows = mixture(400);
  Budget budget{BudgetLimits{}};
  const std::vector<double> shares = forest_importances(rows, kInputs, RandomStream(1), budget);
  double total = 0;
  for (const double share : shares) total += share;
  EXPECT_NEAR(total, 1, 1e-12);
  EXPECT_GT(shares[2], 0.6);
  EXPECT_EQ(most_important(shares, 2), (std::vector<std::size_t>{2, 6}));
  Budget again{BudgetLimits{}};
  EXPECT_EQ(forest_importances(rows, kInputs, RandomStream(1), again), shares);
}

TEST(FeatureSelection, SplitsWhereAStepIs) {
  // A step of x_1 alone: after it no split helps, and all importance is its own. x_0 is a copy and
  // takes it all where it comes first; x_2 is constant.
  std::vector<std::vector<double>> columns(3);
  std::vector<double> target;
  for (int r = 0; r < 40; ++r) {
    columns[0].push_back(r % 7);
    columns[1].push_back(r);
    columns[2].push_back(1);
    target.push_back(r < 13 ? 2 : 9);
  }
  Budget budget{BudgetLimits{}};
  const Rows rows(columns, target);
  const std::vector<double> shares = forest_importances(rows, 3, RandomStream(1), budget);
  EXPECT_NEAR(shares[1], 1, 1e-12);
  columns[0] = columns[1];
  const Rows copied(columns, target);
  EXPECT_NEAR(forest_importances(copied, 3, RandomStream(1), budget)[0], 1, 1e-12);
  const Rows flat(columns, std::vector<double>(40, 3.0));
  EXPECT_EQ(forest_importances(flat, 3, RandomStream(1), budget), (std::vector<double>(3, 0.0)));
}

TEST(FeatureSelection, AgreesWithTreesGrownByHandOnAllRows) {
  // Every bootstrap of two distinct rows drawn apart has one split; of one row drawn twice none.
  const Rows rows({{0, 1}, {0, 0}}, {0, 4});
  Budget budget{BudgetLimits{}};
  const double share = forest_importances(rows, 2, RandomStream(5), budget)[0];
  EXPECT_NEAR(share, 0.5, 0.15);  // half of the trees, give or take
  EXPECT_EQ(forest_importances(rows, 2, RandomStream(5), budget)[1], 0);
}

struct Fit {
  std::vector<Input> inputs;
  std::vector<std::string> names;
  Rows rows = mixture(200);
  std::vector<int> movement = std::vector<int>(200, 0);

  Fit() {
    for (std::size_t j = 0; j < kInputs; ++j) {
      names.push_back("x" + std::to_string(j));
      inputs.push_back({names.back(), "-", Role::none, -1.5, 1.5, {}});
    }
  }
  FitResult operator()(std::int64_t count, std::uint64_t evaluations = 100'000'000,
                       int threads = 1) const {
    const auto method = Registry().make("pysr", {{"select_features", count}});
    const TrainingData data{inputs, rows.pointers, rows.target, movement};
    Budget budget(BudgetLimits{evaluations});
    FitContext context{data, find_operator_set("paper"), budget, RandomStream(2), threads, nullptr};
    return method->fit(context);
  }
};

TEST(FeatureSelection, WithholdsTheOtherInputsFromTheSearch) {
  const Fit fit;
  const FitResult two = fit(2);
  EXPECT_EQ(two.note, "inputs selected: x2 x6");
  for (const Expression& formula : two.front) {
    for (const Node& node : formula.nodes()) {
      EXPECT_TRUE(!node.is_variable() || node.variable == 2 || node.variable == 6)
          << print(formula, fit.names);
    }
  }
  EXPECT_EQ(fit(2, 100'000'000, 4).front, two.front);
  const FitResult all = fit(0);
  EXPECT_TRUE(all.note.empty());
  EXPECT_NE(all.front, two.front);
  EXPECT_EQ(fit(kInputs).front, all.front);
  const FitResult poor = fit(2, 400'000);  // the forest would take 480 000; the search goes on
  EXPECT_EQ(poor.note, "no inputs selected: the budget does not reach");
  EXPECT_GT(poor.front.size(), 1u);
}

TEST(FeatureSelection, AndATemplateExcludeEachOther) {
  EXPECT_THROW(Registry().make("pysr", {{"select_features", std::int64_t{2}},
                                        {"template", std::string("f(v)")}}),
               Error);
}

}  // namespace
}  // namespace tribench::pysr::feature_selection_test
