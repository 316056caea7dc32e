// SPDX-License-Identifier: MIT
#include "algorithms/parfam/published_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/parfam/original.hpp"
#include "foundation/random.hpp"

namespace tribench::parfam {
namespace {

constexpr PublishedModelOptions kExactHidden{.single_precision_hidden = false};

TEST(PublishedModel, LossOfARationalFunctionByHand) {
  // f = (1 + 2 x) / D, D = (3 + 4 x) / 5 after normalisation; x = 1: f = 3 / (7/5) = 15/7,
  // x = 2: f = 5 / (11/5) = 25/11. y = (2, 2): ||y|| = sqrt 8.
  const std::vector<double> x = {1, 2};
  const std::vector<const double*> inputs = {x.data()};
  const std::vector<int> caps = {3};
  PublishedModel model(make_structure({0, 0, 1, 1, {}, false}, caps), inputs, 2);
  const std::vector<double> theta = {1, 2, 3, 4};
  const std::vector<double> y = {2, 2};
  const double error = std::hypot(15.0 / 7 - 2, 25.0 / 11 - 2);
  EXPECT_NEAR(model.loss(theta, y, 0.001, {}), error / std::sqrt(8.0) + 0.001 * 10, 1e-14);
}

TEST(PublishedModel, GuardsDenominatorsWithoutTheirSign) {
  // D = -x / 1 at x = 1e-6: |D| < 1e-5, so D becomes +1e-5.
  const std::vector<double> x = {1e-6};
  const std::vector<const double*> inputs = {x.data()};
  const std::vector<int> caps = {3};
  PublishedModel model(make_structure({0, 0, 1, 1, {}, false}, caps), inputs, 1);
  const std::vector<double> theta = {2, 0, 0, -1};
  EXPECT_NEAR(model.evaluate(theta)[0], 2e5, 1e-6);
}

TEST(PublishedModel, ClipsExpAndRoundsHiddenValuesToSinglePrecision) {
  const std::vector<double> x = {12, 0.3};
  const std::vector<const double*> inputs = {x.data()};
  const std::vector<int> caps = {3};
  const Structure structure = make_structure({1, 0, 1, 0, {Op::exp}, true}, caps);
  PublishedModel model(structure, inputs, 2);
  const std::vector<double> theta = {0, 1, 1};  // exp(x)
  EXPECT_NEAR(model.evaluate(theta)[0], std::exp(10) + 12, 1e-3);
  EXPECT_EQ(model.evaluate(theta)[1], static_cast<double>(static_cast<float>(std::exp(0.3))));
  PublishedModel exact(structure, inputs, 2, kExactHidden);
  EXPECT_NEAR(exact.evaluate(theta)[1], std::exp(0.3), 1e-15);
}

TEST(PublishedModel, NormalisesDenominatorsAndLeavesZeroAlone) {
  std::vector<double> c = {3, 4};
  normalise(c);
  EXPECT_DOUBLE_EQ(c[0], 0.6);
  EXPECT_DOUBLE_EQ(c[1], 0.8);
  std::vector<double> zero = {0, 0};
  normalise(zero);
  EXPECT_EQ(zero[0], 0);
}

TEST(PublishedModel, GradientsOfEveryStructureAgreeWithFiniteDifferences) {
  RandomStream random(3);
  const std::size_t rows = 25;
  for (std::size_t inputs : {1U, 2U, 3U}) {
    std::vector<std::vector<double>> data(inputs, std::vector<double>(rows));
    std::vector<const double*> columns;
    for (auto& column : data) {
      for (double& value : column) value = random.uniform(-1, 1);
      columns.push_back(column.data());
    }
    std::vector<double> y(rows);
    for (double& value : y) value = random.normal();
    const std::vector<int> caps(inputs, kMaximalPotence);
    GridLimits limits = small_grid();
    limits.both_enforce = true;
    limits.base_functions = {Op::sqrt, Op::cos, Op::exp, Op::log, Op::tanh, Op::sin};
    limits.functions = inputs == 1 ? 2 : 1;
    for (const Family& family : published_grid(limits)) {
      PublishedModel model(make_structure(family, caps), columns, rows, kExactHidden);
      std::vector<double> theta(model.parameters());
      for (double& value : theta) value = random.normal();
      std::vector<double> gradient(theta.size());
      model.loss(theta, y, 0.001, gradient);
      const std::size_t k = random.below(theta.size());
      const auto at = [&](double step) {
        std::vector<double> moved = theta;
        moved[k] += step;
        return model.loss(moved, y, 0.001, {});
      };
      const auto central = [&](double h) { return (at(h) - at(-h)) / (2 * h); };
      const double coarse = central(2e-6);
      const double fine = central(1e-6);
      // A kink between the points (a root's, a guard's) shows in the two steps' disagreement.
      if (std::abs(coarse - fine) > 1e-4 * (std::abs(fine) + 1e-2)) continue;
      EXPECT_NEAR(gradient[k], fine, 2e-4 * (std::abs(fine) + 1e-2) + 1e-9 * at(0) / 1e-6)
          << describe(family) << ", " << inputs << " inputs, parameter " << k;
    }
  }
}

TEST(Pruning, AcceptsAsPublished) {
  EXPECT_TRUE(accepts_pruning(0.9, 1.0, 10, 10));  // a smaller error
  EXPECT_FALSE(accepts_pruning(1.0, 1.0, 9, 10));  // the same error, hardly fewer
  EXPECT_TRUE(accepts_pruning(1.49, 1.0, 7, 10));  // 1.5 times the error for 0.75 of the size
  EXPECT_FALSE(accepts_pruning(1.5, 1.0, 7, 10));  // strictly below 1.5
  EXPECT_FALSE(accepts_pruning(1.2, 1.0, 6, 8));   // 6 is not below 0.75 * 8
}

}  // namespace
}  // namespace tribench::parfam
