// SPDX-License-Identifier: MIT
#include "algorithms/fitting/huber_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"v"};

TEST(HuberFit, IsTheMedianWhereTheThresholdIsSmall) {
  const std::vector<double> v = {0, 0, 0, 0, 0};
  const std::vector<const double*> columns = {v.data()};
  const std::vector<double> y = {1, 2, 3, 50, 70};
  Expression formula = parse("10", kNames);
  ConstantFitter fitter;
  fit_huber(fitter, formula, {columns, 5}, y, {.threshold = 0.1, .rounds = 500, .tolerance = 0});
  EXPECT_NEAR(formula.node(0).value, 3, 0.01);
}

TEST(HuberFit, ShrugsOffOutliersThatPullLeastSquaresAway) {
  RandomStream random(4);
  std::vector<double> v;
  std::vector<double> y;
  for (int i = 0; i < 200; ++i) {
    v.push_back(random.uniform(-1, 1));
    y.push_back(3 * v.back() + 2 * std::exp(-v.back()) + 0.05 * random.normal());
    if (i % 10 == 0) y.back() += 20;
  }
  const std::vector<const double*> columns = {v.data()};
  const Inputs inputs{columns, v.size()};
  const auto distance = [](const Expression& formula) {
    const auto places = formula.constant_positions();
    return std::abs(formula.node(places[0]).value - 3) +
           std::abs(formula.node(places[1]).value - 2);
  };
  Expression least_squares = parse("3*v + 2*exp(-1*v)", kNames);
  Expression robust = least_squares;
  ConstantFitter fitter;
  fitter.fit(least_squares, inputs, y);
  const HuberFitResult result = fit_huber(fitter, robust, inputs, y, {.rounds = 100});
  EXPECT_EQ(result.status, FitStatus::converged);
  EXPECT_LT(distance(robust), 0.3);
  EXPECT_GT(distance(least_squares), 3 * distance(robust));
}

}  // namespace
}  // namespace tribench
