// SPDX-License-Identifier: MIT
#include "algorithms/fitting/constant_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/linear_constants.hpp"
#include "foundation/random.hpp"

namespace tribench::constant_fit_test {
namespace {

using testing::DoubleNear;

const std::vector<std::string> kNames = {"v", "s"};
// Table 1 of Scholl et al. 2025, joint 2, ParFam.
constexpr const char* kParFam =
    "(3.66*v + 8.52*s - 0.44)*exp(-0.78*v^2 + 1.26*v*s + 0.02*v - 0.02*s)";

struct Curve {
  std::vector<double> v;
  std::vector<double> s;
  std::vector<double> y;
  std::vector<const double*> columns;
  Inputs inputs() {
    columns = {v.data(), s.data()};
    return {columns, v.size()};
  }
};

// 45 speeds in both directions, as the paper's averaged data.
Curve curve_of(const std::string& law) {
  Curve curve;
  for (int i = 0; i < 90; ++i) {
    const double sign = i < 45 ? -1 : 1;
    curve.v.push_back(sign * (0.015 + 0.68 * (i % 45) / 44.0));
    curve.s.push_back(sign);
  }
  curve.y.resize(90);
  Evaluator().evaluate(parse(law, kNames), curve.inputs(), curve.y);
  return curve;
}

TEST(ConstantFit, FindsALineInOneStepToRounding) {
  Curve curve = curve_of("8.629*s + 14.44*v");
  Expression formula = parse("1*s + 1*v", kNames);
  const ConstantFitResult result = ConstantFitter().fit(formula, curve.inputs(), curve.y);
  EXPECT_EQ(result.status, FitStatus::converged);
  EXPECT_THAT(formula.node(constant_positions(formula)[0]).value, DoubleNear(8.629, 1e-9));
  EXPECT_THAT(formula.node(constant_positions(formula)[1]).value, DoubleNear(14.44, 1e-9));
  EXPECT_LT(result.sum_squares, 1e-18);
}

TEST(ConstantFit, RecoversTheParFamFormulaFromRandomStarts) {
  Curve curve = curve_of(kParFam);
  const Expression truth = parse(kParFam, kNames);
  RandomStream random(1);
  ConstantFitter fitter;
  int recovered = 0;
  for (int start = 0; start < 200; ++start) {
    Expression formula = truth;
    for (std::size_t place : constant_positions(truth)) {
      if (truth.node(place).value != 2) set_constant(formula, place, random.normal());
    }
    const ConstantFitResult result =
        fitter.fit(formula, curve.inputs(), curve.y, {}, {.max_iterations = 100});
    if (result.sum_squares < 1e-12) ++recovered;
  }
  EXPECT_GE(recovered, 90);  // the others crawl along a valley: the seventh constant hardly acts
}

TEST(ConstantFit, SolvesMisra1aOfTheNistReferenceData) {
  // NIST StRD, Misra1a: y = b1 (1 - exp(-b2 x)), start 1, certified to 11 digits.
  std::vector<double> x = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                           378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
  const std::vector<double> y = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                                 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
  std::vector<const double*> columns = {x.data()};
  // Written with one constant more than the reference has: its minimum lies no higher.
  Expression formula = parse("500 - 500*exp(-0.0001*v)", kNames);
  const ConstantFitResult result =
      ConstantFitter().fit(formula, {columns, 14}, y, {}, {.max_iterations = 200});
  EXPECT_EQ(result.status, FitStatus::converged);
  EXPECT_LE(result.sum_squares, 1.2455138894e-1);
}

TEST(ConstantFit, NeverReturnsWorseThanItWasGiven) {
  RandomStream random(2);
  Curve curve = curve_of(kParFam);
  ConstantFitter fitter;
  for (int start = 0; start < 300; ++start) {
    Expression formula = parse("1*exp(1*v)/(1 + 1*s*v) + log(1 + 1*v^2)*1", kNames);
    for (std::size_t place : constant_positions(formula)) {
      set_constant(formula, place, 3 * random.normal());
    }
    std::vector<double> values(90);
    Evaluator().evaluate(formula, curve.inputs(), values);
    double before = 0;
    for (std::size_t i = 0; i < 90; ++i) before += std::pow(values[i] - curve.y[i], 2);
    const ConstantFitResult result = fitter.fit(formula, curve.inputs(), curve.y);
    Evaluator().evaluate(formula, curve.inputs(), values);
    double after = 0;
    for (std::size_t i = 0; i < 90; ++i) after += std::pow(values[i] - curve.y[i], 2);
    if (!std::isfinite(before)) {
      EXPECT_EQ(result.status, FitStatus::not_finite);
      continue;
    }
    EXPECT_LE(after, before * (1 + 1e-12));
    EXPECT_NEAR(after, result.sum_squares, 1e-9 * after);
  }
}

TEST(ConstantFit, LeavesExponentsAloneUnlessTold) {
  Curve curve = curve_of("2*v^4");
  for (double& v : curve.v) v = std::abs(v);
  Expression fixed = parse("1*v^3", kNames);
  ConstantFitter fitter;
  fitter.fit(fixed, curve.inputs(), curve.y);
  EXPECT_EQ(fixed.node(2).value, 3);
  Expression free = parse("1*v^3", kNames);
  const ConstantFitResult result = fitter.fit(
      free, curve.inputs(), curve.y, {}, {.max_iterations = 100, .exponents = FitExponents::all});
  EXPECT_NEAR(free.node(2).value, 4, 1e-6);
  EXPECT_LT(result.sum_squares, 1e-15);
}

TEST(ConstantFit, ThoseThatWereFittedMoveAloneOnRequest) {
  Curve curve = curve_of("2*v^4");
  for (double& v : curve.v) v = std::abs(v);
  const ConstantFitOptions options{.max_iterations = 100, .exponents = FitExponents::not_simple};
  Expression simple = parse("1*v^3.5", kNames);
  ConstantFitter().fit(simple, curve.inputs(), curve.y, {}, options);
  EXPECT_EQ(simple.node(2).value, 3.5);
  Expression fitted = parse("1*v^3.4", kNames);
  ConstantFitter().fit(fitted, curve.inputs(), curve.y, {}, options);
  EXPECT_NEAR(fitted.node(2).value, 4, 1e-6);
}

TEST(ConstantFit, KeepsToBoundsAndFindsTheMinimumOnThem) {
  Curve curve = curve_of("3*s + 2*v");
  Expression formula = parse("1*s + 1*v", kNames);
  const std::vector<double> low = {-10, -10};
  const std::vector<double> high = {10, 1.5};
  const ConstantFitResult result = ConstantFitter().fit(
      formula, curve.inputs(), curve.y, {}, {.max_iterations = 50, .low = low, .high = high});
  EXPECT_EQ(result.status, FitStatus::converged);
  EXPECT_EQ(formula.node(constant_positions(formula)[1]).value, 1.5);
  // With the slope held, the best level takes the mean of what is left: 3 + 0.5 mean |v|.
  double mean = 0;
  for (double v : curve.v) mean += std::abs(v) / 90;
  EXPECT_NEAR(formula.node(constant_positions(formula)[0]).value, 3 + 0.5 * mean, 1e-8);
}

TEST(ConstantFit, WeightsOfZeroTakeRowsOut) {
  Curve curve = curve_of("3*s + 2*v");
  curve.y[7] = 1000;
  std::vector<double> weights(90, 1.0);
  weights[7] = 0;
  Expression formula = parse("1*s + 1*v", kNames);
  ConstantFitter().fit(formula, curve.inputs(), curve.y, weights);
  EXPECT_NEAR(formula.node(constant_positions(formula)[0]).value, 3, 1e-8);
}

TEST(ConstantFit, SaysSoWhereThereIsNothingToFitOrNothingFinite) {
  Curve curve = curve_of("v");
  Expression plain = parse("v*s", kNames);
  EXPECT_EQ(ConstantFitter().fit(plain, curve.inputs(), curve.y).status, FitStatus::no_constants);
  Expression bad = parse("log(-1 - v^2)*2", kNames);
  EXPECT_EQ(ConstantFitter().fit(bad, curve.inputs(), curve.y).status, FitStatus::not_finite);
}

TEST(ConstantFit, LeavesTheFormulaAsItWasWhenItsTimeRunsOut) {
  Curve curve = curve_of(kParFam);
  for (int allowed = 0; allowed < 12; ++allowed) {
    const Expression given = parse("1*exp(1*v)/(1 + 2*s*v)", kNames);
    Expression formula = given;
    int asked = 0;
    const ConstantFitResult result = ConstantFitter().fit(
        formula, curve.inputs(), curve.y, {}, {.in_time = [&] { return ++asked <= allowed; }});
    EXPECT_EQ(result.status, FitStatus::out_of_time) << allowed;
    EXPECT_LE(asked, allowed + 1);  // once it has said no it is not asked again
    EXPECT_EQ(formula, given);
  }
}

TEST(ConstantFit, AClockThatNeverRunsOutChangesNothing) {
  Curve curve = curve_of(kParFam);
  Expression with = parse("1*exp(1*v)/(1 + 2*s*v)", kNames);
  Expression without = with;
  const ConstantFitResult watched =
      ConstantFitter().fit(with, curve.inputs(), curve.y, {}, {.in_time = [] { return true; }});
  const ConstantFitResult plain = ConstantFitter().fit(without, curve.inputs(), curve.y);
  EXPECT_EQ(watched.status, plain.status);
  EXPECT_EQ(watched.node_rows, plain.node_rows);
  EXPECT_EQ(with, without);
}

TEST(ConstantFit, SurvivesRedundantConstants) {
  Curve curve = curve_of("6*v");
  Expression formula = parse("1*(1*(1*v)) + 0*s", kNames);
  const ConstantFitResult result = ConstantFitter().fit(formula, curve.inputs(), curve.y);
  EXPECT_EQ(result.status, FitStatus::converged);
  EXPECT_LT(result.sum_squares, 1e-16);
}

TEST(LinearConstants, AreThoseThatCanBeSolvedForTogether) {
  const auto linear = [](const char* text) {
    const Expression formula = parse(text, kNames);
    std::vector<double> values;
    for (std::size_t place : linear_constants(formula, constant_positions(formula))) {
      values.push_back(formula.node(place).value);
    }
    return values;
  };
  EXPECT_EQ(linear("(2*v + 3*s - 4)*exp(5*v)"), (std::vector<double>{2, 3, 4}));
  EXPECT_EQ(linear("exp(5*v)*(2*v + 3) + 7"), (std::vector<double>{2, 3, 7}));
  EXPECT_EQ(linear("(2*v)*(3*s + 4)"), (std::vector<double>{3, 4}));
  EXPECT_EQ(linear("(2*v + 3)/(1 + 4*v)"), (std::vector<double>{2, 3}));
  EXPECT_EQ(linear("exp(2*v)^3"), (std::vector<double>{}));
  EXPECT_EQ(linear("-(2*v) + sin(3*v)*s"), (std::vector<double>{2}));
}

TEST(ConstantFit, CountsWhatItSpends) {
  Curve curve = curve_of("6*v");
  Expression formula = parse("1*v", kNames);
  const ConstantFitResult result = ConstantFitter().fit(formula, curve.inputs(), curve.y);
  EXPECT_EQ(result.node_rows % (3 * 90), 0U);  // whole passes of three nodes
  EXPECT_GE(result.node_rows, 3U * 90U * 4U);  // a pass, one with sums, a last one at least
}

}  // namespace
}  // namespace tribench::constant_fit_test
