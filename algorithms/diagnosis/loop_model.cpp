// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/loop_model.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kStepTolerance = 1e-6;
constexpr double kRelativeStep = 1e-5;  // of the central differences
// Of a column's square: less beside the others is rounding.
constexpr double kDependent = 1e-11;

// The base's constants that a fit may move: an integer exponent is part of the form.
std::vector<std::size_t> free_constants(const Expression& formula) {
  std::vector<std::size_t> free;
  for (const std::size_t at : formula.constant_positions()) {
    const bool exponent = at + 1 < formula.size() && formula.node(at + 1).op == Op::pow;
    if (!exponent) free.push_back(at);
  }
  return free;
}

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
  for (const std::size_t at : free_constants(model.base.formula)) {
    all.push_back({true, 0, at, -1e300, 1e300});
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
  if (p.of_base) {
    model.base.formula.set_constant(p.place, value);
  } else {
    model.atoms[p.atom].set_shape(p.place, std::clamp(value, p.low, p.high));
  }
}

Eigen::VectorXd evaluate_one(const Expression& formula, const SignalTable& table) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(table.inputs().rows));
  Evaluator().evaluate(formula, table.inputs(), {out.data(), static_cast<std::size_t>(out.size())});
  return out;
}

// What the parameter moves: the base's formula or the atom's columns times their coefficients.
Eigen::VectorXd moved_part(const LoopModel& model, const Nonlinear& p, const SignalTable& table) {
  if (p.of_base) return evaluate_one(model.base.formula, table);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table.inputs().rows));
  const std::size_t first = model.first_column(p.atom);
  const Atom& atom = model.atoms[p.atom];
  for (std::size_t c = 0; c < atom.columns.size(); ++c) {
    sum += model.coefficients[static_cast<Eigen::Index>(first + c)] *
           evaluate_one(atom.columns[c], table);
  }
  return sum;
}

Eigen::VectorXd derivative(LoopModel& model, const Nonlinear& p, const SignalTable& table) {
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

// A shape that a fit has driven to its bound cannot follow its derivative: to project what it
// cannot do out of other effects would hide them (a wide step of the load would hide a gain).
bool held_by_bound(const LoopModel& model, const Nonlinear& p) {
  const double value = value_of(model, p);
  return !p.of_base && (value <= p.low || value >= p.high);
}

std::vector<Expression> linear_columns(const LoopModel& model) {
  std::vector<Expression> all = model.base.linear_terms;
  for (const Atom& atom : model.atoms) {
    all.insert(all.end(), atom.columns.begin(), atom.columns.end());
  }
  return all;
}

// Lengths of columns; 1 of those that are nothing.
Eigen::VectorXd lengths_of(const Eigen::MatrixXd& x) {
  Eigen::VectorXd lengths = x.colwise().norm();
  for (double& length : lengths) length = length > 0 && std::isfinite(length) ? length : 1;
  return lengths;
}

// The linear part at the present shapes: whitened columns of unit length, their products, and what
// is left of the target beside them.
struct LinearFit {
  Eigen::MatrixXd x;
  Eigen::VectorXd lengths;
  Eigen::MatrixXd gram;
  Eigen::VectorXd residual;
  double sum_squares = 0;
};

// Solves for the linear coefficients.
LinearFit solve_linear(LoopModel& model, const Observations& data, const Clusters& clusters,
                       const Noise& noise) {
  const SignalTable table(data);
  Eigen::VectorXd y = target_vector(data);
  if (!model.base.formula.empty()) y -= evaluate_one(model.base.formula, table);
  LinearFit fit;
  fit.residual = whitened(y, clusters, noise);
  fit.x = whitened(evaluate_columns(linear_columns(model), data), clusters, noise);
  if (fit.x.cols() > 0) {
    fit.lengths = lengths_of(fit.x);
    for (Eigen::Index j = 0; j < fit.x.cols(); ++j) fit.x.col(j) /= fit.lengths[j];
    fit.gram = fit.x.transpose() * fit.x;
    const Eigen::VectorXd solution =
        basic_solution_symmetric(fit.gram, fit.x.transpose() * fit.residual, kDependent);
    model.coefficients = solution.cwiseQuotient(fit.lengths);
    fit.residual -= fit.x * solution;
  }
  fit.sum_squares = fit.residual.squaredNorm();
  return fit;
}

// What the non-linear parameters can do that the linear ones cannot: the products of the Jacobian's
// columns, the linear columns projected out, and its products with the residual.
struct NonlinearNormal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd gradient;
};

NonlinearNormal nonlinear_normal(LoopModel& model, const std::vector<Nonlinear>& parameters,
                                 const Observations& data, const Clusters& clusters,
                                 const Noise& noise, const LinearFit& fit) {
  const SignalTable table(data);
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(data.rows()),
                           static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    jacobian.col(static_cast<Eigen::Index>(j)) = derivative(model, parameters[j], table);
  }
  jacobian = whitened(std::move(jacobian), clusters, noise);
  NonlinearNormal out{jacobian.transpose() * jacobian, jacobian.transpose() * fit.residual};
  if (fit.x.cols() == 0) return out;
  const Eigen::VectorXd whole = out.gram.diagonal();
  const Eigen::MatrixXd cross = fit.x.transpose() * jacobian;
  out.gram -= cross.transpose() * basic_solution_symmetric(fit.gram, cross, kDependent);
  out.gram.diagonal() = out.gram.diagonal().cwiseMax(kDependent * whole);
  return out;
}

// A damped step; parameters that would leave their bounds stop at them. Returns its relative size.
double take_step(LoopModel& model, const std::vector<Nonlinear>& parameters,
                 const NonlinearNormal& normal, double damping) {
  const Eigen::VectorXd scale = normal.gram.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Eigen::MatrixXd damped =
      scale.cwiseInverse().asDiagonal() * normal.gram * scale.cwiseInverse().asDiagonal();
  damped.diagonal().array() += damping;
  const Eigen::VectorXd step =
      solve_symmetric(damped, normal.gradient.cwiseQuotient(scale)).cwiseQuotient(scale);
  double largest = 0;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double before = value_of(model, parameters[j]);
    const double change = step[static_cast<Eigen::Index>(j)];
    if (!std::isfinite(change)) continue;
    set_value(model, parameters[j], before + change);
    const double after = value_of(model, parameters[j]);
    largest = std::max(largest, std::abs(after - before) / (before != 0 ? std::abs(before) : 1.0));
  }
  return largest;
}

}  // namespace

void add_rigid_terms(BaseModel& base, const Observations& data) {
  const std::vector<std::string> names = data.names();
  for (const std::string& name : data.rigid) {
    if (data.find(name) != nullptr) base.linear_terms.push_back(parse(name, names));
  }
}

BaseModel coulomb_viscous_base(const Observations& data) {
  BaseModel base;
  base.name = "coulomb_viscous";
  const std::vector<std::string> names = data.names();
  if (data.find("v") == nullptr || data.find("sgn_v") == nullptr) {
    throw_bad_input("the loop needs a velocity", data.target_name,
                    "name it: --roles COLUMN=velocity");
  }
  for (const char* term : {"sgn_v", "1", "v", "abs(v)"}) {
    base.linear_terms.push_back(parse(term, names));
  }
  add_rigid_terms(base, data);
  return base;
}

BaseModel formula_base(const Observations& data, std::string_view text) {
  // A formula may use the signals' short names and the names of the file's columns.
  std::vector<std::string> names = data.names();
  const std::size_t signals = names.size();
  for (const Signal& signal : data.signals) names.push_back(signal.channel);
  const Expression parsed = parse(text, names);
  std::vector<Node> nodes(parsed.nodes().begin(), parsed.nodes().end());
  for (Node& node : nodes) {
    if (node.is_variable() && node.variable >= signals) {
      node = Node::input(node.variable - signals);
    }
  }
  BaseModel base;
  base.name = "formula";
  base.formula = Expression(std::move(nodes));
  add_rigid_terms(base, data);
  return base;
}

void LoopModel::add(Atom atom) {
  const auto columns = static_cast<Eigen::Index>(atom.columns.size());
  const Eigen::Index before = coefficients.size();
  coefficients.conservativeResize(before + columns);
  coefficients.tail(columns).setZero();
  atoms.push_back(std::move(atom));
}

void LoopModel::remove(std::size_t atom) {
  const auto first = static_cast<Eigen::Index>(first_column(atom));
  const auto columns = static_cast<Eigen::Index>(atoms[atom].columns.size());
  const Eigen::Index rest = coefficients.size() - first - columns;
  const Eigen::VectorXd tail = coefficients.tail(rest);
  coefficients.conservativeResize(coefficients.size() - columns);
  coefficients.tail(rest) = tail;
  atoms.erase(atoms.begin() + static_cast<std::ptrdiff_t>(atom));
}

std::size_t LoopModel::first_column(std::size_t atom) const {
  std::size_t first = base.linear_terms.size();
  for (std::size_t k = 0; k < atom; ++k) first += atoms[k].columns.size();
  return first;
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  const Eigen::VectorXd lengths = lengths_of(columns);
  const Eigen::MatrixXd scaled = columns * lengths.cwiseInverse().asDiagonal();
  return basic_solution_symmetric(scaled.transpose() * scaled, scaled.transpose() * target,
                                  kDependent)
      .cwiseQuotient(lengths);
}

Eigen::MatrixXd evaluate_columns(std::span<const Expression> formulas, const Observations& data) {
  const SignalTable table(data);
  Evaluator evaluator;
  Eigen::MatrixXd out(static_cast<Eigen::Index>(data.rows()),
                      static_cast<Eigen::Index>(formulas.size()));
  for (std::size_t j = 0; j < formulas.size(); ++j) {
    evaluator.evaluate(formulas[j], table.inputs(),
                       {out.col(static_cast<Eigen::Index>(j)).data(), data.rows()});
  }
  return out;
}

Eigen::Map<const Eigen::VectorXd> target_vector(const Observations& data) {
  return {data.target.data(), static_cast<Eigen::Index>(data.rows())};
}

Eigen::VectorXd predict(const LoopModel& model, const Observations& data) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.rows()));
  if (!model.base.formula.empty()) out = evaluate_one(model.base.formula, SignalTable(data));
  if (model.coefficients.size() > 0) {
    out += evaluate_columns(linear_columns(model), data) * model.coefficients;
  }
  return out;
}

Eigen::MatrixXd tangent(const LoopModel& model, const Observations& data) {
  LoopModel copy = model;
  const SignalTable table(data);
  const std::vector<Nonlinear> parameters = nonlinear_parameters(model);
  const Eigen::MatrixXd linear = evaluate_columns(linear_columns(model), data);
  Eigen::MatrixXd out(linear.rows(), linear.cols() + static_cast<Eigen::Index>(parameters.size()));
  out.leftCols(linear.cols()) = linear;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    auto column = out.col(linear.cols() + static_cast<Eigen::Index>(j));
    if (held_by_bound(model, parameters[j])) {
      column.setZero();
    } else {
      column = derivative(copy, parameters[j], table);
    }
  }
  return out;
}

void fit_model(LoopModel& model, const Observations& data, const Clusters& clusters,
               const Noise& noise, FitScope scope) {
  LinearFit fit = solve_linear(model, data, clusters, noise);
  const std::vector<Nonlinear> parameters =
      scope == FitScope::everything ? nonlinear_parameters(model) : std::vector<Nonlinear>();
  if (parameters.empty()) return;
  double damping = 1e-3;
  for (int i = 0; i < kMaxIterations; ++i) {
    const NonlinearNormal normal = nonlinear_normal(model, parameters, data, clusters, noise, fit);
    bool improved = false;
    double step = 0;
    double decrease = 0;
    for (int attempt = 0; attempt < 6 && !improved; ++attempt) {
      LoopModel trial = model;
      step = take_step(trial, parameters, normal, damping);
      LinearFit trial_fit = solve_linear(trial, data, clusters, noise);
      improved = trial_fit.sum_squares < fit.sum_squares;
      damping *= improved ? 0.2 : 8;
      if (!improved) continue;
      decrease = 1 - trial_fit.sum_squares / fit.sum_squares;
      model = std::move(trial);
      fit = std::move(trial_fit);
    }
    if (!improved || step < kStepTolerance || decrease < 1e-9) return;
  }
}

Expression formula_of(const LoopModel& model) {
  Expression sum = model.base.formula;
  const std::vector<Expression> columns = linear_columns(model);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const double coefficient = model.coefficients[static_cast<Eigen::Index>(j)];
    if (coefficient == 0) continue;
    const bool is_one = columns[j].size() == 1 && columns[j].node(0).is_constant();
    const Expression term =
        is_one ? Expression::constant(coefficient * columns[j].node(0).value)
               : Expression::binary(Op::mul, Expression::constant(coefficient), columns[j]);
    sum = sum.empty() ? term : Expression::binary(Op::add, sum, term);
  }
  return sum.empty() ? Expression::constant(0) : sum;
}

std::string formula_text(const LoopModel& model, const Observations& data) {
  return print(formula_of(model), data.names());
}

}  // namespace tribench::loop
