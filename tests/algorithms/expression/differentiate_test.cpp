// SPDX-License-Identifier: MIT
#include "algorithms/expression/differentiate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench::differentiate_test {
namespace {

const std::vector<std::string> kNames = {"x", "y"};

struct Points {
  std::vector<std::vector<double>> values;
  std::vector<const double*> columns;
  explicit Points(std::size_t rows, std::uint64_t seed = 7) : values(2, std::vector<double>(rows)) {
    RandomStream random(seed);
    for (auto& column : values) {
      for (double& value : column) value = random.uniform(-1.5, 1.5);
      columns.push_back(column.data());
    }
  }
  Inputs inputs() const { return {columns, values[0].size()}; }
};

// A random formula whose derivatives exist almost everywhere on the points.
void grow(RandomStream& random, int depth, std::vector<Node>& tape) {
  if (depth == 0 || random.chance(0.2)) {
    tape.push_back(random.chance(0.5) ? Node::constant(random.uniform(0.3, 2.0))
                                      : Node::input(random.below(2)));
    return;
  }
  static constexpr Op kOps[] = {Op::add, Op::sub, Op::mul, Op::div,  Op::pow,
                                Op::neg, Op::exp, Op::log, Op::sqrt, Op::abs,
                                Op::sgn, Op::sin, Op::cos, Op::tanh, Op::atan};
  const Op op = kOps[random.below(std::size(kOps))];
  grow(random, depth - 1, tape);
  if (op == Op::pow) {
    static constexpr double kExponents[] = {0, 1, 2, 3, 5, -1, -2, 0.5, 1.7};
    tape.push_back(Node::constant(kExponents[random.below(std::size(kExponents))]));
  } else if (arity(op) == 2) {
    grow(random, depth - 1, tape);
  }
  tape.push_back({0, 0, 0, op});
}

std::vector<std::size_t> constants_outside_exponents(const Expression& formula) {
  std::vector<std::size_t> places = constant_positions(formula);
  std::erase_if(places, [&](std::size_t i) {
    return i + 1 < formula.size() && formula.node(i + 1).op == Op::pow;
  });
  return places;
}

// tanh(log 0) is -1, and has no slope.
bool is_finite_throughout(const Expression& formula, std::span<const double> point) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!std::isfinite(Evaluator().evaluate_at(subtree(formula, i), point))) return false;
  }
  return true;
}

// Central difference and what its own error may be, from two step lengths.
struct Slope {
  double value;
  double error;
};
template <typename F>
Slope slope_of(F f, double at) {
  const double h = 1e-4 * std::max(1.0, std::abs(at));
  const auto central = [&](double step) { return (f(at + step) - f(at - step)) / (2 * step); };
  const double coarse = central(2 * h);
  const double fine = central(h);
  const double rounding = 1e-11 * (std::abs(f(at)) + 1) / h;
  return {fine + (fine - coarse) / 3, std::abs(fine - coarse) + rounding};
}

TEST(Differentiate, ConstantsAgreeWithFiniteDifferencesOnRandomFormulas) {
  const Points points(37);
  RandomStream random(11);
  Evaluator evaluator;
  Differentiator differentiator;
  int compared = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    std::vector<Node> tape;
    grow(random, 4, tape);
    Expression formula(tape);
    const auto places = constants_outside_exponents(formula);
    if (places.empty()) continue;
    std::vector<double> values(37);
    std::vector<double> jacobian(37 * places.size());
    differentiator.prepare(formula, places);
    differentiator.jacobian(points.inputs(), values, jacobian);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const std::size_t row = random.below(37);
      const std::vector<double> point = {points.values[0][row], points.values[1][row]};
      if (!is_finite_throughout(formula, point)) continue;
      const double at = formula.node(places[k]).value;
      const Slope slope = slope_of(
          [&](double c) {
            Expression moved = formula;
            set_constant(moved, places[k], c);
            return evaluator.evaluate_at(moved, point);
          },
          at);
      if (!std::isfinite(slope.value) || slope.error > 1e-3 * (1 + std::abs(slope.value))) continue;
      const double exact = jacobian[k * 37 + row];
      EXPECT_NEAR(exact, slope.value, 20 * slope.error + 1e-6 * std::abs(slope.value))
          << print(formula, kNames) << " constant " << k << " row " << row;
      ++compared;
    }
    for (std::size_t row = 0; row < 37; ++row) {
      const double expected =
          evaluator.evaluate_at(formula, std::vector{points.values[0][row], points.values[1][row]});
      if (!std::isfinite(expected)) continue;
      EXPECT_NEAR(values[row], expected, 1e-12 * std::abs(expected));
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(Differentiate, InputsAgreeWithFiniteDifferencesOnRandomFormulas) {
  const Points points(23);
  RandomStream random(12);
  Evaluator evaluator;
  Differentiator differentiator;
  int compared = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    std::vector<Node> tape;
    grow(random, 4, tape);
    const Expression formula(tape);
    std::vector<double> gradient(2 * 23);
    differentiator.prepare_for_inputs(formula, 2);
    differentiator.jacobian(points.inputs(), {}, gradient);
    for (std::size_t j = 0; j < 2; ++j) {
      const std::size_t row = random.below(23);
      std::vector<double> point = {points.values[0][row], points.values[1][row]};
      if (!is_finite_throughout(formula, point)) continue;
      const double at = point[j];
      const Slope slope = slope_of(
          [&](double x) {
            point[j] = x;
            return evaluator.evaluate_at(formula, point);
          },
          at);
      if (!std::isfinite(slope.value) || slope.error > 1e-3 * (1 + std::abs(slope.value))) continue;
      EXPECT_NEAR(gradient[j * 23 + row], slope.value,
                  20 * slope.error + 1e-6 * std::abs(slope.value))
          << print(formula, kNames) << " input " << j << " at " << at;
      ++compared;
    }
  }
  EXPECT_GT(compared, 1500);
}

TEST(Differentiate, SumsEqualThoseOfTheStoredJacobian) {
  for (std::size_t rows : {1U, 7U, 90U, 200U, 1500U}) {
    const Points points(rows);
    const Expression formula =
        parse("(3.66*x + 8.52*y - 0.44)*exp(-0.78*x^2 + 1.26*x*y + 0.02*x) + 5", kNames);
    const auto places = constants_outside_exponents(formula);
    const std::size_t p = places.size();
    RandomStream random(3);
    std::vector<double> target(rows);
    std::vector<double> weights(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      target[r] = random.normal();
      weights[r] = random.uniform();
    }
    Differentiator differentiator;
    differentiator.prepare(formula, places);
    std::vector<double> values(rows);
    std::vector<double> jacobian(rows * p);
    differentiator.jacobian(points.inputs(), values, jacobian);
    NormalEquations sums;
    differentiator.normal_equations(points.inputs(), target, weights, sums);
    double squares = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      squares += weights[r] * (values[r] - target[r]) * (values[r] - target[r]);
    }
    EXPECT_NEAR(sums.sum_squares, squares, 1e-12 * squares);
    for (std::size_t k = 0; k < p; ++k) {
      for (std::size_t l = 0; l < p; ++l) {
        double dot = 0;
        double size = 0;
        for (std::size_t r = 0; r < rows; ++r) {
          const double term = weights[r] * jacobian[k * rows + r] * jacobian[l * rows + r];
          dot += term;
          size += std::abs(term);
        }
        EXPECT_NEAR(sums.curvature[k * p + l], dot, 1e-13 * size);
      }
      double gradient = 0;
      double size = 0;
      for (std::size_t r = 0; r < rows; ++r) {
        const double term = weights[r] * jacobian[k * rows + r] * (values[r] - target[r]);
        gradient += term;
        size += std::abs(term);
      }
      EXPECT_NEAR(sums.gradient[k], gradient, 1e-13 * size);
    }
    // The second way to the same sums: values first, derivatives from what is still there.
    NormalEquations again;
    differentiator.sum_squares(points.inputs(), target, weights);
    differentiator.normal_equations(points.inputs(), target, weights, again);
    EXPECT_EQ(sums.curvature, again.curvature);
    EXPECT_EQ(sums.gradient, again.gradient);
  }
}

TEST(Differentiate, ExponentsAreParametersLikeOthers) {
  std::vector<double> x = {0, 0.5, 2};
  std::vector<const double*> columns = {x.data()};
  const Expression formula = parse("x^1.5 + 2^x^1.5", std::vector<std::string>{"x"});
  const auto places = constant_positions(formula);  // 1.5, 2, 1.5
  Differentiator differentiator;
  differentiator.prepare(formula, places);
  std::vector<double> jacobian(9);
  differentiator.jacobian({columns, 3}, {}, jacobian);
  EXPECT_EQ(jacobian[0], 0);  // the limit
  for (std::size_t r = 1; r < 3; ++r) {
    const double power = std::pow(x[r], 1.5);
    const double outer = std::pow(2, power);
    EXPECT_NEAR(jacobian[r], power * std::log(x[r]), 1e-14);
    EXPECT_NEAR(jacobian[3 + r], power * std::pow(2, power - 1), 1e-13);
    EXPECT_NEAR(jacobian[6 + r], outer * std::log(2) * power * std::log(x[r]), 1e-13);
  }
}

TEST(Differentiate, KeepsToItsConventions) {
  std::vector<double> x = {-2, 0, 3};
  std::vector<const double*> columns = {x.data()};
  const auto slopes = [&](const char* text) {
    Differentiator differentiator;
    std::vector<double> result(3);
    differentiator.prepare_for_inputs(parse(text, std::vector<std::string>{"x"}), 1);
    differentiator.jacobian({columns, 3}, {}, result);
    return result;
  };
  EXPECT_EQ(slopes("sgn(x)"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(slopes("abs(x)"), (std::vector<double>{-1, 0, 1}));
  EXPECT_EQ(slopes("x^3"), (std::vector<double>{12, 0, 27}));
  EXPECT_EQ(slopes("x^0"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(slopes("x^1"), (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(slopes("5"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(slopes("sqrt(x)")[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(slopes("atan(x)"), (std::vector<double>{0.2, 1, 0.1}));
  EXPECT_EQ(slopes("x*x + x"), (std::vector<double>{-3, 1, 7}));
}

}  // namespace
}  // namespace tribench::differentiate_test
