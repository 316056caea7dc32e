// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_sum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/fitting/subset_average.hpp"
#include "foundation/random.hpp"

namespace tribench::linear_sum_test {
namespace {

// Of two columns at right angles, of unit length, every subset's slopes are the same.
TEST(SubsetAverage, IsTheMeanOfAllSubsetsByTheirWeights) {
  constexpr double kRows = 20;
  constexpr std::array<double, 2> kAlong = {0.8, 0.1};
  constexpr double kSquare = 1;
  double total = 0;
  std::array<double, 2> slopes{};
  for (int subset = 0; subset < 4; ++subset) {
    const int k = (subset & 1) + (subset >> 1);
    double explained = 0;
    for (int j = 0; j < 2; ++j) explained += (subset >> j & 1) * kAlong[j] * kAlong[j];
    for (int power = -1; power <= 10; ++power) {
      const double g = kRows * std::pow(10, power);
      const double weight = (k == 1 ? 1.0 / 6 : 1.0 / 3) * g / kRows *
                            std::pow(1 + g / kRows, -1.5) * std::pow(1 + g, (kRows - 1 - k) / 2) *
                            std::pow(1 + g * (1 - explained / kSquare), -(kRows - 1) / 2);
      total += weight;
      for (int j = 0; j < 2; ++j) {
        slopes[j] += (subset >> j & 1) * weight * kAlong[j] * g / (1 + g);
      }
    }
  }
  const std::vector<double> products = {1,         0,         kAlong[0], 0,      1,
                                        kAlong[1], kAlong[0], kAlong[1], kSquare};
  const std::vector<double> found = average_over_subsets(products, 20, 2);
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(found[j], slopes[j] / total, 1e-12);
  EXPECT_LT(found[1], 0.5 * kAlong[1]) << "of what hardly stands out of the noise little is left";
}

TEST(SubsetAverage, PaysForEveryColumnThatCouldHaveBeenTaken) {
  const std::vector<double> products = {1, 0.6, 0.6, 1};
  const double alone = average_over_subsets(products, 20, 1)[0];
  const double of_fifty = average_over_subsets(products, 20, 50)[0];
  EXPECT_GT(alone, 0.45);
  EXPECT_LT(of_fifty, 0.8 * alone);
}

TEST(SubsetAverage, TakesColumnsThatAreSumsOfOthersAndATargetThatStandsStill) {
  const std::vector<double> twice = {1, 1, 0.9, 1, 1, 0.9, 0.9, 0.9, 1};
  const std::vector<double> slopes = average_over_subsets(twice, 30, 2);
  EXPECT_NEAR(slopes[0] + slopes[1], 0.9, 0.05);
  EXPECT_NEAR(slopes[0], slopes[1], 1e-12);
  EXPECT_EQ(average_over_subsets(std::vector<double>{1, 0, 0, 0}, 30, 1)[0], 0);
}

struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;

  // The first `telling` of the inputs, which have something in common, have a slope of 1.
  Rows(int count, int inputs, int telling, double noise, RandomStream random) {
    columns.resize(static_cast<std::size_t>(inputs));
    for (int r = 0; r < count; ++r) {
      const double common = random.normal();
      double sum = 0;
      for (std::size_t j = 0; j < columns.size(); ++j) {
        columns[j].push_back(0.5 * common + random.normal());
        if (j < static_cast<std::size_t>(telling)) sum += columns[j].back();
      }
      target.push_back(2 + sum + noise * random.normal());
    }
    for (const auto& column : columns) pointers.push_back(column.data());
  }

  Inputs table() const { return {pointers, target.size()}; }
};

double mean_square(const Expression& formula, const Rows& rows) {
  return Evaluator().sum_squared_errors(formula, rows.table(), rows.target).sum /
         static_cast<double>(rows.target.size());
}

double mean_square_of_all_inputs(const Rows& rows, const Rows& unseen) {
  const std::vector<double> ones(rows.target.size(), 1.0);
  std::vector<const double*> pointers = {ones.data()};
  pointers.insert(pointers.end(), rows.pointers.begin(), rows.pointers.end());
  const std::vector<double> c = solve_least_squares(pointers, rows.target).coefficients;
  double sum = 0;
  for (std::size_t r = 0; r < unseen.target.size(); ++r) {
    double value = c[0];
    for (std::size_t j = 0; j < unseen.columns.size(); ++j) {
      value += c[j + 1] * unseen.columns[j][r];
    }
    sum += (value - unseen.target[r]) * (value - unseen.target[r]);
  }
  return sum / static_cast<double>(unseen.target.size());
}

// What a chosen line would lose: that fewer inputs speak than there are, or that all do.
TEST(LinearSum, ErrsLittleOnFewRowsWhetherFewInputsSpeakOrAll) {
  constexpr int kDraws = 20;
  for (const int telling : {2, 12}) {
    double own = 0;
    double of_all = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const RandomStream random = RandomStream(5).split(telling).split(draw);
      const double noise = telling == 2 ? 1.0 : 8.0;
      const Rows rows(35, 12, telling, noise, random);
      const Rows unseen(500, 12, telling, noise, random.split("unseen"));
      const Expression sum = fit_linear_sum(rows.table(), rows.target, {}).formula;
      own += mean_square(sum, unseen) / (noise * noise) - 1;
      of_all += mean_square_of_all_inputs(rows, unseen) / (noise * noise) - 1;
    }
    EXPECT_LT(own, (telling == 2 ? 0.5 : 0.8) * of_all) << telling << " inputs speak";
  }
}

TEST(LinearSum, SaysHowWellAndWritesNoInputThatSaysNothing) {
  const RandomStream random(8);
  const Rows rows(300, 20, 3, 0.1, random);
  const LinearSum sum = fit_linear_sum(rows.table(), rows.target, {});
  const Rows unseen(2000, 20, 3, 0.1, random.split("unseen"));
  EXPECT_NEAR(mean_square(sum.formula, unseen), sum.held_out, 0.25 * sum.held_out);
  EXPECT_EQ(columns_used(sum.formula), 3U);
}

}  // namespace
}  // namespace tribench::linear_sum_test
