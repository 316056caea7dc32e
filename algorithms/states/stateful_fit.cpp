// SPDX-License-Identifier: MIT
#include "algorithms/states/stateful_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kLogReach = 4.605170185988091;  // a factor of 100
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

class JointProblem : public LeastSquaresProblem {
 public:
  JointProblem(StatefulFormula& formula, const StatefulRows& rows)
      : formula_(formula),
        rows_(rows),
        places_(free_constants(formula.formula)),
        states_(formula.states.size(), std::vector<double>(rows.target.size())),
        errors_(rows.target.size()) {
    by_constants_.prepare(formula.formula, places_);

    columns_.assign(rows.columns.begin(), rows.columns.end());
    for (const std::vector<double>& state : states_) columns_.push_back(state.data());
  }

  std::vector<double> start() {
    std::vector<double> x;
    for (const std::size_t place : places_) add(x, formula_.formula.node(place).value, kUnbounded);
    each_parameter([&](double& value, bool is_any) {
      if (is_any) {
        add(x, value, kUnbounded);
      } else {
        add(x, elementary::log(value), kLogReach);
      }
    });
    return x;
  }
  std::span<const double> low() const { return low_; }
  std::span<const double> high() const { return high_; }

  // Writes a point into the formula.
  void set(std::span<const double> x) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      set_constant(formula_.formula, places_[i], x[i]);
    }
    by_constants_.set_constants(x.first(places_.size()));
    std::size_t next = places_.size();
    each_parameter([&](double& value, bool is_any) {
      value = is_any ? x[next] : elementary::exp(x[next]);
      ++next;
    });
  }

  double sum_squares(std::span<const double> x) override {
    set(x);
    std::vector<double> along(rows_.motion.rows());
    for (std::size_t k = 0; k < states_.size(); ++k) {
      state_column(formula_.states[k], rows_.motion, along);
      for (std::size_t r = 0; r < errors_.size(); ++r) states_[k][r] = along[rows_.motion_row[r]];
    }
    by_constants_.evaluate(inputs(), errors_);
    double sum = 0;
    for (std::size_t r = 0; r < errors_.size(); ++r) {
      errors_[r] -= rows_.target[r];
      sum += errors_[r] * errors_[r];
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  void normal_equations(NormalEquations& sums) override {
    const std::size_t n = errors_.size();
    std::vector<double> jacobian(places_.size() * n);
    by_constants_.jacobian(inputs(), {}, jacobian);
    add_parameter_columns(jacobian);
    const std::size_t p = n == 0 ? 0 : jacobian.size() / n;
    sums.sum_squares = 0;
    sums.gradient.assign(p, 0);
    sums.curvature.assign(p * p, 0);
    for (const double error : errors_) sums.sum_squares += error * error;
    for (std::size_t i = 0; i < p; ++i) {
      const double* a = jacobian.data() + i * n;
      for (std::size_t r = 0; r < n; ++r) sums.gradient[i] += a[r] * errors_[r];
      for (std::size_t j = 0; j <= i; ++j) {
        const double* b = jacobian.data() + j * n;
        double product = 0;
        for (std::size_t r = 0; r < n; ++r) product += a[r] * b[r];
        sums.curvature[i * p + j] = product;
        sums.curvature[j * p + i] = product;
      }
    }
  }

 private:
  Inputs inputs() const { return {columns_, errors_.size()}; }

  void add(std::vector<double>& x, double value, double reach) {
    x.push_back(value);
    low_.push_back(value - reach);
    high_.push_back(value + reach);
  }

  template <typename Visit>
  void each_parameter(const Visit& visit) {
    for (StateDeclaration& state : formula_.states) {
      const StateLawInfo& law = state_law_info(state.law);
      for (std::size_t k = 0; k < state.parameters.size(); ++k) {
        visit(state.parameters[k], law.parameters[k].may_be_any);
      }
    }
  }

  // df/dz dz/dp, for log p where p is above 0.
  void add_parameter_columns(std::vector<double>& jacobian) {
    const std::size_t n = errors_.size();
    std::vector<double> slopes((formula_.first_state + states_.size()) * n);
    by_inputs_.prepare_for_inputs(formula_.formula, formula_.first_state + states_.size());
    by_inputs_.jacobian(inputs(), {}, slopes);
    for (std::size_t s = 0; s < states_.size(); ++s) {
      const StateDeclaration& state = formula_.states[s];
      const StateSensitivities found = state_sensitivities(state, rows_.motion);
      const double* by_state = slopes.data() + (formula_.first_state + s) * n;
      for (std::size_t k = 0; k < state.parameters.size(); ++k) {
        const bool is_any = state_law_info(state.law).parameters[k].may_be_any;
        const double scale = is_any ? 1 : state.parameters[k];
        for (std::size_t r = 0; r < n; ++r) {
          jacobian.push_back(by_state[r] * found.by_parameter[k][rows_.motion_row[r]] * scale);
        }
      }
    }
  }

  StatefulFormula& formula_;
  const StatefulRows& rows_;
  std::vector<std::size_t> places_;
  std::vector<std::vector<double>> states_;
  std::vector<const double*> columns_;
  std::vector<double> errors_;
  std::vector<double> low_;
  std::vector<double> high_;
  Differentiator by_constants_;
  Differentiator by_inputs_;
};

}  // namespace

StatefulFitFigures fit_stateful(StatefulFormula& formula, const StatefulRows& rows) {
  const StatefulFormula given = formula;
  JointProblem problem(formula, rows);
  std::vector<double> x = problem.start();
  StatefulFitFigures figures;
  figures.before = figures.after = problem.sum_squares(x);
  if (!std::isfinite(figures.before) || x.empty()) {
    formula = given;  // to the last bit: parameters went through their logarithms
    return figures;
  }
  LevenbergMarquardtOptions options;
  options.max_iterations = 60;
  options.low = problem.low();
  options.high = problem.high();
  LevenbergMarquardt walker;
  figures.iterations = walker.minimize(problem, x, options).iterations;
  figures.after = problem.sum_squares(x);  // leaves the best point in the formula
  if (!(figures.after < figures.before)) {
    formula = given;
    figures.after = figures.before;
  }
  return figures;
}

}  // namespace tribench
