// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/motion_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "foundation/error.hpp"

namespace tribench::forward {
namespace {

constexpr double kDifference = 1e-4;  // of a parameter
constexpr double kLeast = 1e-12;      // of inertia, motor constant and resistance
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- least squares of the equation of motion

struct EquationRows {
  std::vector<std::vector<double>> columns;
  std::vector<double> target;  // the drive less the friction
};

JointInstant measured_instant(const MovementRows& rows, std::size_t row,
                              std::vector<double>& recorded) {
  recorded.clear();
  for (const std::span<const double>& column : rows.recorded) recorded.push_back(column[row]);
  JointInstant at;
  at.time = rows.time[row];
  at.position = rows.position[row];
  at.velocity = rows.velocity[row];
  at.drive = rows.drive[row];
  at.is_connected = rows.connected.empty() || rows.connected[row] != 0;
  at.since_commit = 0;
  at.recorded = recorded;
  return at;
}

void add_rows(const JointModel& model, const RigidBodyTerms& terms, const MovementRows& rows,
              std::span<const double> acceleration, double slowest, EquationRows& all) {
  JointModel without = model;
  if (!terms.gravity.empty()) without.gravity.reset();
  if (without.inertia <= 0) without.inertia = 1;  // not looked at: only the friction is
  JointEquation equation(without, "the model");
  Evaluator evaluator;
  std::vector<double> recorded;
  for (std::size_t row = 0; row < rows.time.size(); ++row) {
    JointInstant at = measured_instant(rows, row, recorded);
    if (row == 0) {
      equation.begin(at);
    } else {
      at.since_commit = rows.time[row] - rows.time[row - 1];
      equation.commit(at);
      at.since_commit = 0;
    }
    if (std::abs(at.velocity) < slowest || at.velocity == 0) continue;
    const double friction = equation.friction(at, at.velocity > 0 ? 1 : -1, acceleration[row]);
    double target = equation.motor_torque(at) - friction - equation.gravity(at);
    std::size_t k = 0;
    if (terms.inertia) {
      all.columns[k++].push_back(acceleration[row]);
    } else {
      target -= model.inertia * acceleration[row];
    }
    for (const Expression& term : terms.gravity) {
      all.columns[k++].push_back(evaluator.evaluate_at(term, std::span(&at.position, 1)));
    }
    all.target.push_back(target);
  }
}

Expression sum_of(std::span<const Expression> terms, std::span<const double> coefficients) {
  Expression sum;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Expression term =
        Expression::binary(Op::mul, Expression::constant(coefficients[k]), terms[k]);
    sum = sum.empty() ? term : Expression::binary(Op::add, sum, term);
  }
  return sum;
}

// ---- simulated against measured positions

// The free parameters of a model, in one order.
class ParameterList {
 public:
  ParameterList(JointModel& model, const FreeParameters& free) {
    if (free.inertia && model.inertia > 0) add(&model.inertia, kLeast);
    if (free.gravity && model.gravity) add_constants(*model.gravity);
    if (free.motor && model.motor) {
      add(&model.motor->constant, kLeast);
      add(&model.motor->resistance, kLeast);
    }
    if (free.friction) add_constants(model.friction);
  }

  std::vector<double> values() const {
    std::vector<double> all;
    for (const One& one : list_) {
      all.push_back(one.number ? *one.number : one.formula->node(one.place).value);
    }
    return all;
  }
  void set(std::span<const double> values) {
    for (std::size_t k = 0; k < list_.size(); ++k) {
      if (list_[k].number) {
        *list_[k].number = values[k];
      } else {
        set_constant(*list_[k].formula, list_[k].place, values[k]);
      }
    }
  }
  const std::vector<double>& low() const { return low_; }
  std::size_t size() const { return list_.size(); }

 private:
  struct One {
    double* number = nullptr;
    Expression* formula = nullptr;
    std::size_t place = 0;
  };
  void add(double* number, double low) {
    list_.push_back({number, nullptr, 0});
    low_.push_back(low);
  }
  void add_constants(Expression& formula) {
    for (const std::size_t place : free_constants(formula)) {
      list_.push_back({nullptr, &formula, place});
      low_.push_back(-kInfinity);
    }
  }

  std::vector<One> list_;
  std::vector<double> low_;
};

class OutputError : public LeastSquaresProblem {
 public:
  OutputError(JointModel& model, const Controller* controller,
              std::span<const MovementRows> movements, ParameterList& parameters,
              const SimulationOptions& options)
      : model_(model),
        controller_(controller),
        movements_(movements),
        parameters_(parameters),
        options_(options) {}

  double sum_squares(std::span<const double> x) override {
    at_.assign(x.begin(), x.end());
    residual_ = residuals(x);
    return square(residual_);
  }

  void normal_equations(NormalEquations& sums) override {
    const std::size_t p = at_.size();
    std::vector<std::vector<double>> columns;
    for (std::size_t k = 0; k < p; ++k) columns.push_back(column(k));
    sums.sum_squares = square(residual_);
    sums.gradient.assign(p, 0);
    sums.curvature.assign(p * p, 0);
    for (std::size_t j = 0; j < p; ++j) {
      sums.gradient[j] = dot(columns[j], residual_);
      for (std::size_t k = 0; k <= j; ++k) {
        sums.curvature[j * p + k] = sums.curvature[k * p + j] = dot(columns[j], columns[k]);
      }
    }
  }

  std::uint64_t simulations() const { return simulations_; }
  std::size_t rows() const { return residual_.size(); }

 private:
  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }
  static double square(const std::vector<double>& r) { return r.empty() ? kInfinity : dot(r, r); }

  // Empty where a movement has no simulated motion.
  std::vector<double> residuals(std::span<const double> x) {
    parameters_.set(x);
    ++simulations_;
    std::vector<double> all;
    for (const MovementRows& rows : movements_) {
      const SimulatedMotion motion = simulate_motion(model_, controller_, rows, options_);
      if (motion.status != MotionStatus::complete) return {};
      for (std::size_t i = 0; i < rows.time.size(); ++i) {
        all.push_back(motion.position[i] - rows.position[i]);
      }
    }
    return all;
  }

  std::vector<double> column(std::size_t k) {
    std::vector<double> x = at_;
    const double size = std::abs(at_[k]);
    const double step = kDifference * (size > 0 ? size : 1e-3);
    x[k] += step;
    std::vector<double> moved = residuals(x);
    if (moved.size() != residual_.size()) return std::vector<double>(residual_.size(), 0.0);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = (moved[i] - residual_[i]) / step;
    return moved;
  }

  JointModel& model_;
  const Controller* controller_;
  std::span<const MovementRows> movements_;
  ParameterList& parameters_;
  const SimulationOptions& options_;
  std::vector<double> at_;
  std::vector<double> residual_;
  std::uint64_t simulations_ = 0;
};

}  // namespace

double fit_rigid_body(JointModel& model, const RigidBodyTerms& terms,
                      std::span<const MovementRows> movements,
                      std::span<const std::vector<double>> acceleration, std::string_view place) {
  const std::size_t unknowns = (terms.inertia ? 1 : 0) + terms.gravity.size();
  if (unknowns == 0) return 0;
  double top = 0;
  for (const MovementRows& rows : movements) {
    for (const double v : rows.velocity) top = std::max(top, std::abs(v));
  }
  EquationRows all;
  all.columns.resize(unknowns);
  for (std::size_t m = 0; m < movements.size(); ++m) {
    add_rows(model, terms, movements[m], acceleration[m], kSlowestFitted * top, all);
  }
  std::vector<const double*> columns;
  for (const auto& column : all.columns) columns.push_back(column.data());
  for (const double value : all.target) {
    if (!std::isfinite(value)) {
      throw_bad_input("the formula has no finite value at a row of the data", place,
                      "see: tribench check 'FORMULA' --box ...");
    }
  }
  const LinearFit fit = solve_least_squares(columns, all.target);
  if (fit.rank < static_cast<int>(unknowns)) {
    throw_bad_input("the data do not determine inertia and gravity", place,
                    "give them, or record movements that speed up and cover more of the range");
  }
  std::span<const double> coefficients = fit.coefficients;
  if (terms.inertia) {
    if (!(coefficients[0] > 0)) {
      throw_bad_input(
          fmt::format("the fitted inertia is {:.4g}", coefficients[0]), place,
          "is the torque's sign right (give --flip-sign, or leave it out)? else give the "
          "inertia");
    }
    model.inertia = coefficients[0];
    coefficients = coefficients.subspan(1);
  }
  if (!terms.gravity.empty()) model.gravity = sum_of(terms.gravity, coefficients);
  return std::sqrt(fit.sum_squares / static_cast<double>(all.target.size()));
}

MotionFit fit_to_motion(JointModel& model, const Controller* controller,
                        std::span<const MovementRows> movements, const FreeParameters& free,
                        const SimulationOptions& options, int most_iterations) {
  ParameterList parameters(model, free);
  MotionFit result;
  result.parameters = static_cast<int>(parameters.size());
  OutputError error(model, controller, movements, parameters, options);
  std::vector<double> x = parameters.values();
  const std::vector<double> start = x;
  const double before = error.sum_squares(x);
  const auto rms = [&](double squares) {
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, error.rows())));
  };
  result.rms_before = result.rms_after = rms(before);
  result.simulations = error.simulations();
  if (!std::isfinite(before) || x.empty()) return result;
  LevenbergMarquardt solver;
  LevenbergMarquardtOptions steps;
  steps.max_iterations = most_iterations;
  steps.gradient_tolerance = 1e-6;
  steps.step_tolerance = 1e-6;
  steps.function_tolerance = 1e-7;
  steps.low = parameters.low();
  const LevenbergMarquardtResult end = solver.minimize(error, x, steps);
  parameters.set(end.sum_squares <= before ? x : start);
  result.rms_after = rms(std::min(before, end.sum_squares));
  result.iterations = end.iterations;
  result.simulations = error.simulations();
  return result;
}

}  // namespace tribench::forward
