// SPDX-License-Identifier: MIT
#include "algorithms/parfam/projection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algorithms/parfam/formula.hpp"
#include "foundation/random.hpp"

namespace tribench::parfam {
namespace {

struct Sample {
  std::vector<std::vector<double>> data;
  std::vector<const double*> columns;
  std::vector<double> y;
  Sample(std::size_t inputs, std::size_t rows, std::uint64_t seed)
      : data(inputs, std::vector<double>(rows)), y(rows) {
    RandomStream random(seed);
    for (auto& column : data) {
      for (double& value : column) value = random.uniform(-1, 1);
      columns.push_back(column.data());
    }
    for (double& value : y) value = random.normal();
  }
};

std::vector<Family> families(int functions) {
  GridLimits limits = small_grid();
  limits.base_functions = {Op::sqrt, Op::cos, Op::exp, Op::log, Op::tanh, Op::sin};
  limits.functions = functions;
  return published_grid(limits);
}

TEST(Projection, GradientsOfEveryStructureAgreeWithFiniteDifferences) {
  RandomStream random(5);
  int compared = 0;
  for (std::size_t inputs : {1U, 2U}) {
    const Sample sample(inputs, 60, 9);
    const std::vector<int> caps(inputs, kMaximalPotence);
    for (const Family& family : families(inputs == 1 ? 2 : 1)) {
      for (const Denominators kind : {Denominators::safe, Denominators::free}) {
        const Structure structure = make_structure(family, caps);
        Budget budget{BudgetLimits{}};
        Projection projection(structure, sample.columns, sample.y, kind, budget);
        const std::size_t n = projection.inner_parameters();
        if (n == 0) continue;
        std::vector<double> inner(n);
        for (double& value : inner) value = 0.5 * random.normal();
        NormalEquations sums;
        const double here = projection.sum_squares(inner);
        projection.normal_equations(sums);
        // Of a nearly dependent basis the coefficients are known to rounding only.
        if (std::ranges::any_of(projection.coefficients(),
                                [](double c) { return std::abs(c) > 100; })) {
          continue;
        }
        const std::size_t k = random.below(n);
        const auto central = [&](double h) {
          std::vector<double> moved = inner;
          moved[k] += h;
          const double above = projection.sum_squares(moved);
          moved[k] = inner[k] - h;
          return (above - projection.sum_squares(moved)) / (2 * h);
        };
        const double coarse = central(2e-5);
        const double fine = central(1e-5);
        const double tolerance = 1e-3 * (std::abs(fine) + 1e-2 * here);
        if (!std::isfinite(fine) || std::abs(coarse - fine) > tolerance) continue;
        EXPECT_NEAR(2 * sums.gradient[k], fine, 2 * tolerance) << describe(family);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Projection, SolvesTheLinearPartExactly) {
  // y = 2 + 3 exp(-x): with the right inner parameter nothing is left.
  Sample sample(1, 40, 2);
  for (std::size_t r = 0; r < 40; ++r) sample.y[r] = 2 + 3 * std::exp(-sample.data[0][r]);
  Structure structure;
  structure.inputs = 1;
  structure.functions = {Op::exp};
  structure.numerators = {{{1}}};
  structure.denominators = {{}};
  structure.out_numerator = {{0, 0}, {0, 1}};
  Budget budget{BudgetLimits{}};
  Projection projection(structure, sample.columns, sample.y, Denominators::safe, budget);
  const std::vector<double> inner = {-1};
  EXPECT_LT(projection.sum_squares(inner), 1e-22);
  EXPECT_NEAR(projection.coefficients()[0], 2, 1e-10);
  EXPECT_NEAR(projection.coefficients()[1], 3, 1e-10);
}

TEST(Projection, IsNotDefinedWithoutBudget) {
  const Sample sample(1, 10, 1);
  const std::vector<int> caps = {3};
  Budget budget{BudgetLimits{.evaluations = 5}};
  Projection projection(make_structure({1, 0, 1, 0, {Op::exp}, false}, caps), sample.columns,
                        sample.y, Denominators::safe, budget);
  const std::vector<double> inner = {0, 1};
  EXPECT_TRUE(std::isnan(projection.sum_squares(inner)));
  EXPECT_EQ(budget.spent(), 0U);
}

TEST(Formula, IsTheFunctionThatWasTrained) {
  RandomStream random(6);
  for (std::size_t inputs : {1U, 2U, 3U}) {
    const Sample raw(inputs, 50, 4);
    const std::vector<double> scales = {2.5, 0.01, 60};
    std::vector<std::vector<double>> unscaled = raw.data;
    std::vector<const double*> columns;
    for (std::size_t j = 0; j < inputs; ++j) {
      for (double& value : unscaled[j]) value *= scales[j];
      columns.push_back(unscaled[j].data());
    }
    const std::vector<int> caps(inputs, kMaximalPotence);
    for (const Family& family : families(1)) {
      for (const Denominators kind : {Denominators::safe, Denominators::free}) {
        const Structure structure = make_structure(family, caps);
        Budget budget{BudgetLimits{}};
        Projection projection(structure, raw.columns, raw.y, kind, budget);
        TrainedModel model{structure, std::vector<double>(projection.inner_parameters()), {}, 0};
        for (double& value : model.inner) value = random.normal();
        model.sum_squares = projection.sum_squares(model.inner);
        if (!std::isfinite(model.sum_squares)) continue;
        model.coefficients.assign(projection.coefficients().begin(),
                                  projection.coefficients().end());
        const Expression formula = formula_of(model, scales, kind, find_operator_set("full"));
        std::vector<double> values(50);
        Evaluator().evaluate(formula, {columns, 50}, values);
        double squares = 0;
        for (std::size_t r = 0; r < 50; ++r) {
          squares += (values[r] - raw.y[r]) * (values[r] - raw.y[r]);
        }
        // Coefficients of a nearly dependent basis are large and cancel.
        double size = 1;
        for (double c : model.coefficients) size = std::max(size, std::abs(c));
        EXPECT_NEAR(squares, model.sum_squares, 1e-9 * size * (1 + model.sum_squares))
            << describe(family);
      }
    }
  }
}

}  // namespace
}  // namespace tribench::parfam
