// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/model_fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kStepTolerance = 1e-6;
constexpr double kRelativeStep = 1e-5;  // of the central differences
// Of a column's square: less beside the others is rounding.
constexpr double kDependent = 1e-11;
constexpr double kSameShape = 1.5;  // one within that factor of another

// One non-linear parameter: where it is, its value and its bounds.
struct Nonlinear {
  bool of_base;
  std::size_t atom;   // or unused
  std::size_t place;  // node of the base's formula, or shape of the atom
  double low;
  double high;
};

std::vector<Nonlinear> nonlinear_parameters(const LoopModel& model) {
  std::vector<Nonlinear> all;
  for (const FittedConstant& constant : fitted_constants(model.base)) {
    all.push_back({true, 0, constant.place, constant.range.low, constant.range.high});
  }
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    for (std::size_t s = 0; s < model.atoms[k].shapes.size(); ++s) {
      const Shape& shape = model.atoms[k].shapes[s];
      if (shape.refined()) all.push_back({false, k, s, shape.low, shape.high});
    }
  }
  return all;
}

double value_of(const LoopModel& model, const Nonlinear& p) {
  return p.of_base ? model.base.formula.node(p.place).value
                   : model.atoms[p.atom].shapes[p.place].value;
}

void set_value(LoopModel& model, const Nonlinear& p, double value) {
  const double within = std::clamp(value, p.low, p.high);
  if (p.of_base) {
    set_constant(model.base.formula, p.place, within);
  } else {
    model.atoms[p.atom].set_shape(p.place, within);
  }
}

// What a shape moves: its atom's columns times their coefficients.
Eigen::VectorXd moved_part(const LoopModel& model, const Nonlinear& p, const SignalTable& table) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table.inputs().rows));
  const std::size_t first = model.first_column(p.atom);
  const Atom& atom = model.atoms[p.atom];
  for (std::size_t c = 0; c < atom.columns.size(); ++c) {
    sum += model.coefficients[static_cast<Eigen::Index>(first + c)] *
           evaluate_column(atom.columns[c], table);
  }
  return sum;
}

// Of the base's constants, exactly. Where there is none (of 0^c by c, of a root at 0) a row says
// nothing: 0.
Eigen::MatrixXd base_derivatives(const Expression& formula, std::span<const std::size_t> places,
                                 const SignalTable& table) {
  const std::size_t rows = table.inputs().rows;
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(rows),
                          static_cast<Eigen::Index>(places.size()));
  if (places.empty()) return columns;
  Differentiator differentiator;
  differentiator.prepare(formula, places);
  differentiator.jacobian(table.inputs(), {}, {columns.data(), rows * places.size()});
  return columns.unaryExpr([](double x) { return std::isfinite(x) ? x : 0; });
}

Eigen::VectorXd shape_derivative(LoopModel& model, const Nonlinear& p, const SignalTable& table) {
  const double value = value_of(model, p);
  const double step = kRelativeStep * (value != 0 ? std::abs(value) : 1e-3);
  const double above = std::min(value + step, p.high);
  const double below = std::max(value - step, p.low);
  set_value(model, p, above);
  const Eigen::VectorXd up = moved_part(model, p, table);
  set_value(model, p, below);
  const Eigen::VectorXd down = moved_part(model, p, table);
  set_value(model, p, value);
  return (up - down) / (above - below);
}

// What a fit has driven to its bound cannot follow its derivative: to project what it cannot do out
// of other effects would hide them (a wide step of the load would hide a gain).
bool held_by_bound(const LoopModel& model, const Nonlinear& p) {
  const double value = value_of(model, p);
  return value <= p.low || value >= p.high;
}

// The derivatives of the prediction, one column a parameter.
Eigen::MatrixXd jacobian_of(LoopModel& model, const std::vector<Nonlinear>& parameters,
                            const Observations& data) {
  const SignalTable table(data);
  std::vector<std::size_t> places;  // the base's come first
  for (const Nonlinear& p : parameters) {
    if (p.of_base) places.push_back(p.place);
  }
  Eigen::MatrixXd out(static_cast<Eigen::Index>(data.rows()),
                      static_cast<Eigen::Index>(parameters.size()));
  out.leftCols(static_cast<Eigen::Index>(places.size())) =
      base_derivatives(model.base.formula, places, table);
  for (std::size_t j = places.size(); j < parameters.size(); ++j) {
    out.col(static_cast<Eigen::Index>(j)) = shape_derivative(model, parameters[j], table);
  }
  return out;
}

// The linear part at the present shapes: whitened columns of unit length, their products, and what
// is left of the target beside them. Between the steps of a fit only the columns that have shapes
// are worked out again.
class LinearPart {
 public:
  LinearPart(const Observations& data, const Clusters& clusters, const Noise& noise)
      : data_(&data), clusters_(&clusters), noise_(&noise) {}

  // Works out all columns, and solves for the coefficients.
  void begin(LoopModel& model) {
    x_ = whitened(evaluate_columns(linear_columns(model), *data_), *clusters_, *noise_);
    lengths_ = Eigen::VectorXd::Ones(x_.cols());
    for (Eigen::Index j = 0; j < x_.cols(); ++j) scale(j);
    gram_ = gram_of(x_);
    renew_target(model);
    solve(model);
  }

  // The same after a change of shapes.
  void renew(LoopModel& model) {
    const SignalTable table(*data_);
    for (std::size_t k = 0; k < model.atoms.size(); ++k) {
      const Atom& atom = model.atoms[k];
      if (!std::ranges::any_of(atom.shapes, &Shape::refined)) continue;
      const auto first = static_cast<Eigen::Index>(model.first_column(k));
      const auto count = static_cast<Eigen::Index>(atom.columns.size());
      for (Eigen::Index c = 0; c < count; ++c) {
        x_.col(first + c) = whitened(
            evaluate_column(atom.columns[static_cast<std::size_t>(c)], table), *clusters_, *noise_);
        scale(first + c);
      }
      const Eigen::MatrixXd products = cross_products(x_, x_.middleCols(first, count));
      gram_.middleCols(first, count) = products;
      gram_.middleRows(first, count) = products.transpose();
    }
    renew_target(model);
    solve(model);
  }

  const Eigen::MatrixXd& columns() const { return x_; }
  const Eigen::MatrixXd& gram() const { return gram_; }
  const Eigen::VectorXd& residual() const { return residual_; }
  double sum_squares() const { return sum_squares_; }

 private:
  void scale(Eigen::Index j) {
    const double length = x_.col(j).norm();
    lengths_[j] = length > 0 && std::isfinite(length) ? length : 1;
    x_.col(j) /= lengths_[j];
  }

  void renew_target(const LoopModel& model) {
    if (y_.size() > 0 && model.base.formula.empty()) return;
    Eigen::VectorXd y = target_vector(*data_);
    if (!model.base.formula.empty()) y -= evaluate_column(model.base.formula, SignalTable(*data_));
    y_ = whitened(y, *clusters_, *noise_);
  }

  void solve(LoopModel& model) {
    residual_ = y_;
    if (x_.cols() > 0) {
      const Eigen::VectorXd solution =
          basic_solution_symmetric(gram_, cross_products(x_, y_), kDependent);
      model.coefficients = solution.cwiseQuotient(lengths_);
      residual_ = less_combination(residual_, x_, solution);
    }
    sum_squares_ = residual_.squaredNorm();
  }

  const Observations* data_;
  const Clusters* clusters_;
  const Noise* noise_;
  Eigen::MatrixXd x_;
  Eigen::VectorXd lengths_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd y_;
  Eigen::VectorXd residual_;
  double sum_squares_ = 0;
};

// What the non-linear parameters can do that the linear ones cannot: the products of the Jacobian's
// columns, the linear columns projected out, and its products with the residual.
struct NonlinearNormal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient;
};

NonlinearNormal nonlinear_normal(LoopModel& model, const std::vector<Nonlinear>& parameters,
                                 const Observations& data, const Clusters& clusters,
                                 const Noise& noise, const LinearPart& fit) {
  const Eigen::MatrixXd jacobian = whitened(jacobian_of(model, parameters, data), clusters, noise);
  NonlinearNormal out{gram_of(jacobian), cross_products(jacobian, fit.residual())};
  if (fit.columns().cols() == 0) return out;
  const Eigen::VectorXd whole = out.gram.diagonal();
  const Eigen::MatrixXd cross = cross_products(fit.columns(), jacobian);
  out.gram -= cross.transpose() * basic_solution_symmetric(fit.gram(), cross, kDependent);
  out.gram.diagonal() = out.gram.diagonal().cwiseMax(kDependent * whole);
  return out;
}

bool is_close(const Shape& a, const Shape& b) {
  const double ratio = a.value / b.value;
  return a.value == b.value || (ratio > 1 / kSameShape && ratio < kSameShape);
}

// The same columns, and nearly the same shapes.
bool are_one(const Atom& a, Atom b) {
  if (a.family != b.family || !std::ranges::equal(a.shapes, b.shapes, is_close)) return false;
  for (std::size_t s = 0; s < a.shapes.size(); ++s) b.set_shape(s, a.shapes[s].value);
  return a.columns == b.columns;
}

// What is left of two effects that have become one is a derivative, whose huge coefficients are no
// effect's size.
bool has_merged_atoms(const LoopModel& model) {
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& one = model.atoms[k];
    if (std::ranges::none_of(one.shapes, &Shape::refined)) continue;
    const auto others = std::span(model.atoms).subspan(k + 1);
    if (std::ranges::any_of(others, [&](const Atom& other) { return are_one(one, other); })) {
      return true;
    }
  }
  return false;
}

// The base's constants whose step leads out of the bound at which they stand. A shape that is
// driven to its bound stands for another cause, and need not become better at that.
std::vector<std::size_t> led_out(const LoopModel& model, const std::vector<Nonlinear>& parameters,
                                 const Eigen::VectorXd& step) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < parameters.size() && parameters[j].of_base; ++j) {
    const double value = value_of(model, parameters[j]);
    const double change = step[static_cast<Eigen::Index>(j)];
    if ((change < 0 && value <= parameters[j].low) || (change > 0 && value >= parameters[j].high)) {
      out.push_back(j);
    }
  }
  return out;
}

// The solution of a step's equations in which no constant is led out of its bound: the others must
// not reckon with what it cannot do (an active set, Gill, Murray and Wright 1981, section 5.2).
Eigen::VectorXd step_within(const LoopModel& model, const std::vector<Nonlinear>& parameters,
                            Eigen::MatrixXd normal, Eigen::VectorXd gradient) {
  for (std::size_t held = 0;; ++held) {
    const Eigen::VectorXd step = solve_symmetric(normal, gradient);
    const std::vector<std::size_t> out = led_out(model, parameters, step);
    if (out.empty() || held == parameters.size()) return step;
    for (const std::size_t j : out) {
      const auto at = static_cast<Eigen::Index>(j);
      normal.row(at).setZero();
      normal.col(at).setZero();
      normal(at, at) = 1;
      gradient[at] = 0;
    }
  }
}

// A damped step; parameters that would leave their bounds stop at them. Returns its relative size.
double take_step(LoopModel& model, const std::vector<Nonlinear>& parameters,
                 const NonlinearNormal& normal, double damping) {
  const Eigen::VectorXd scale = normal.gram.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Eigen::MatrixXd damped =
      scale.cwiseInverse().asDiagonal() * normal.gram * scale.cwiseInverse().asDiagonal();
  damped.diagonal().array() += damping;
  const Eigen::VectorXd step =
      step_within(model, parameters, damped, normal.gradient.cwiseQuotient(scale))
          .cwiseQuotient(scale);
  double largest = 0;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double before = value_of(model, parameters[j]);
    const double change = step[static_cast<Eigen::Index>(j)];
    if (!std::isfinite(change)) continue;
    set_value(model, parameters[j], before + change);
    const double moved = std::abs(value_of(model, parameters[j]) - before);
    // From zero every step is a large one.
    if (moved > 0) largest = std::max(largest, before != 0 ? moved / std::abs(before) : 1.0);
  }
  return largest;
}

}  // namespace

Eigen::VectorXd least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  Eigen::VectorXd lengths = columns.colwise().norm();
  for (double& length : lengths) length = length > 0 && std::isfinite(length) ? length : 1;
  const Eigen::MatrixXd scaled = columns * lengths.cwiseInverse().asDiagonal();
  return basic_solution_symmetric(gram_of(scaled), cross_products(scaled, target), kDependent)
      .cwiseQuotient(lengths);
}

Eigen::MatrixXd tangent(const LoopModel& model, const Observations& data) {
  LoopModel copy = model;
  const std::vector<Nonlinear> parameters = nonlinear_parameters(model);
  const Eigen::MatrixXd linear = evaluate_columns(linear_columns(model), data);
  Eigen::MatrixXd out(linear.rows(), linear.cols() + static_cast<Eigen::Index>(parameters.size()));
  out << linear, jacobian_of(copy, parameters, data);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (held_by_bound(model, parameters[j])) {
      out.col(linear.cols() + static_cast<Eigen::Index>(j)).setZero();
    }
  }
  return out;
}

void fit_model(LoopModel& model, const Observations& data, const Clusters& clusters,
               const Noise& noise, FitScope scope) {
  LinearPart fit(data, clusters, noise);
  fit.begin(model);
  const std::vector<Nonlinear> parameters =
      scope == FitScope::everything ? nonlinear_parameters(model) : std::vector<Nonlinear>();
  if (parameters.empty()) return;
  double damping = 1e-3;
  LinearPart trial_fit = fit;
  for (int i = 0; i < kMaxIterations; ++i) {
    const NonlinearNormal normal = nonlinear_normal(model, parameters, data, clusters, noise, fit);
    bool improved = false;
    double step = 0;
    double decrease = 0;
    for (int attempt = 0; attempt < 6 && !improved; ++attempt) {
      LoopModel trial = model;
      step = take_step(trial, parameters, normal, damping);
      trial_fit.renew(trial);
      improved = trial_fit.sum_squares() < fit.sum_squares() && !has_merged_atoms(trial);
      damping *= improved ? 0.2 : 8;
      if (!improved) continue;
      decrease = 1 - trial_fit.sum_squares() / fit.sum_squares();
      model = std::move(trial);
      std::swap(fit, trial_fit);
    }
    if (!improved || step < kStepTolerance || decrease < 1e-9) return;
  }
}

}  // namespace tribench::loop
