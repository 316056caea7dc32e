// SPDX-License-Identifier: MIT
#include "algorithms/states/stateful_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"v", "g"};

struct Recording {
  std::vector<double> time;
  std::vector<double> v;
  std::vector<double> g;
  std::vector<double> target;
  std::vector<std::size_t> rows;  // every third is fitted
  std::vector<double> row_v;
  std::vector<double> row_g;
  std::vector<std::size_t> starts = {0};
  std::vector<const double*> motion;
  std::vector<const double*> columns;

  Recording(const std::string& law, double noise) {
    RandomStream random(4);
    for (int r = 0; r < 6000; ++r) {
      time.push_back(0.002 * r);
      v.push_back(0.05 * std::sin(2.4 * time.back()) + 0.03 * std::sin(7.1 * time.back()));
      g.push_back(std::cos(0.9 * time.back()));
    }
    motion = {v.data(), g.data()};
    const StatefulFormula planted = parse_stateful(law, kNames);
    std::vector<const double*> all = motion;
    std::vector<std::vector<double>> states;
    for (const StateDeclaration& state : planted.states) {
      states.emplace_back(v.size());
      state_column(state, {motion, time, starts}, states.back());
      all.push_back(states.back().data());
    }
    std::vector<double> values(v.size());
    Evaluator().evaluate(planted.formula, {all, v.size()}, values);
    for (std::size_t r = 0; r < v.size(); r += 3) {
      rows.push_back(r);
      row_v.push_back(v[r]);
      row_g.push_back(g[r]);
      target.push_back(values[r] + noise * random.normal());
    }
    columns = {row_v.data(), row_g.data()};
  }
  StatefulRows fitted() const { return {columns, target, {motion, time, starts}, rows}; }
};

TEST(StatefulFit, MovesConstantsAndParametersTogether) {
  const Recording recording(
      "z = lugre(v, sliding=0.0005, breakaway=0.0009, stribeck_velocity=0.012); "
      "6000*z + 1200*z*g + 4*v",
      0.02);
  StatefulFormula formula = parse_stateful(
      "z = lugre(v, sliding=0.001, breakaway=0.0015, stribeck_velocity=0.02); "
      "3000*z + 300*z*g + 1*v",
      kNames);
  const StatefulFitFigures figures = fit_stateful(formula, recording.fitted());
  EXPECT_NEAR(std::sqrt(figures.after / 2000), 0.02, 0.001);
  EXPECT_GT(figures.before, 100 * figures.after);
  EXPECT_NEAR(formula.formula.node(0).value, 6000, 600);
  EXPECT_NEAR(formula.states[0].parameters[0], 0.0005, 0.00005);
  EXPECT_NEAR(formula.states[0].parameters[2], 0.012, 0.0012);
}

TEST(StatefulFit, AParameterOfAnySignMoves) {
  const Recording recording("b = backlash(v, g, half_gap=0.01, drift=-0.02); 200*b + 3*v", 0.01);
  StatefulFormula formula =
      parse_stateful("b = backlash(v, g, half_gap=0.008, drift=0.001); 150*b + 2*v", kNames);
  const StatefulFitFigures figures = fit_stateful(formula, recording.fitted());
  EXPECT_NEAR(std::sqrt(figures.after / 2000), 0.01, 0.001);
  EXPECT_NEAR(formula.states[0].parameters[1], -0.02, 0.001);
}

TEST(StatefulFit, LeavesWhatHasNoValueAndExponentsAlone) {
  const Recording recording("z = lag(v, time_constant=0.05); 20*z^2 + 1", 0.001);
  StatefulFormula formula = parse_stateful("z = lag(v, time_constant=0.1); 15*z^2 + 0.5", kNames);
  fit_stateful(formula, recording.fitted());
  EXPECT_EQ(print_stateful(formula, kNames).find("^2") == std::string::npos, false);
  EXPECT_NEAR(formula.states[0].parameters[0], 0.05, 0.005);
  StatefulFormula without = parse_stateful("z = lag(v, time_constant=0.1); log(0*z - 1)", kNames);
  const StatefulFormula before = without;
  EXPECT_TRUE(std::isinf(fit_stateful(without, recording.fitted()).after));
  EXPECT_EQ(print_stateful(without, kNames), print_stateful(before, kNames));
}

}  // namespace
}  // namespace tribench
