// SPDX-License-Identifier: MIT
#include "algorithms/pysr/denoise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/registry.hpp"

namespace tribench::pysr {
namespace {

constexpr double kNoise = 0.3;

// 50 (s + exp(-v^2)) [N m] with noise of 15 N m, v and s its sign.
struct Bump {
  Rows rows;
  std::vector<double> truth;

  explicit Bump(std::size_t count) {
    RandomStream random(key_of("bump"));
    std::vector<std::vector<double>> columns(2);
    std::vector<double> target;
    for (std::size_t r = 0; r < count; ++r) {
      const double v = random.uniform(-2, 2);
      columns[0].push_back(v);
      columns[1].push_back(v > 0 ? 1 : -1);
      truth.push_back(50 * (columns[1].back() + std::exp(-v * v)));
      target.push_back(truth.back() + 50 * kNoise * random.normal());
    }
    rows = {std::move(columns), std::move(target)};
  }
};

constexpr std::size_t kBoth[] = {0, 1};

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += (a[r] - b[r]) * (a[r] - b[r]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Denoise, ComesNearerToTheTruthThanTheRowsAndKnowsTheirNoise) {
  const Bump data(300);
  Budget budget{BudgetLimits{}};
  const auto smooth = denoised(data.rows, data.rows, kBoth, RandomStream(1), budget);
  ASSERT_TRUE(smooth.has_value());
  EXPECT_LT(rms(smooth->target, data.truth), 0.35 * rms(data.rows.target, data.truth));
  EXPECT_NEAR(smooth->noise, 50 * kNoise, 5 * kNoise);
  EXPECT_GT(budget.spent(), 0u);
  Budget again{BudgetLimits{}};
  EXPECT_EQ(denoised(data.rows, data.rows, kBoth, RandomStream(1), again)->target, smooth->target);
}

TEST(Denoise, BoundsTheRowsItIsTrainedOn) {
  const Bump data(3 * kTrainingRows);
  Budget budget{BudgetLimits{}};
  const auto smooth = denoised(data.rows, data.rows, kBoth, RandomStream(1), budget);
  ASSERT_TRUE(smooth.has_value());
  ASSERT_EQ(smooth->target.size(), data.rows.size());
  EXPECT_LT(rms(smooth->target, data.truth), 0.2 * rms(data.rows.target, data.truth));
}

TEST(Denoise, AsksTheBudgetFirst) {
  const Bump data(100);
  Budget budget{BudgetLimits{1000}};
  EXPECT_FALSE(denoised(data.rows, data.rows, kBoth, RandomStream(1), budget).has_value());
  EXPECT_FALSE(budget.exhausted());  // what is there is the search's
}

TEST(Denoise, ChangesWhatIsFoundAndFitsItToTheMeasuredRows) {
  const Bump data(120);
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -2, 2, {}},
                                     {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};
  const std::vector<int> movement(data.rows.size(), 0);
  const TrainingData training{inputs, data.rows.pointers, data.rows.target, movement};
  const auto fit = [&](bool denoise, int threads) {
    const auto method = Registry().make("pysr", {{"denoise", denoise}});
    Budget budget{BudgetLimits{}};
    FitContext context{training, find_operator_set("paper"), budget, RandomStream(4), threads,
                       nullptr};
    return method->fit(context);
  };
  const FitResult with = fit(true, 1);
  EXPECT_EQ(with.note.substr(0, 15), "denoised: noise");
  EXPECT_NE(with.front, fit(false, 1).front);
  EXPECT_EQ(with.front, fit(true, 4).front);
  // Nothing is gained by fitting the choice to the measured rows once more.
  Expression chosen = with.front[with.chosen];
  std::vector<double> values(data.rows.size());
  Evaluator().evaluate(chosen, data.rows.inputs(), values);
  const double before = rms(values, data.rows.target);
  const ConstantFitResult again =
      ConstantFitter().fit(chosen, data.rows.inputs(), data.rows.target);
  const double after = std::sqrt(again.sum_squares / static_cast<double>(values.size()));
  EXPECT_NEAR(after, before, 1e-6 * before);
}

}  // namespace
}  // namespace tribench::pysr
