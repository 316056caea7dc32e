// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/loop_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

bool has_free_constants(const Expression& formula) { return !free_constants(formula).empty(); }

// The formula over its one free constant, which stands as a factor; none where it does not.
std::optional<Expression> over_its_factor(const Expression& formula) {
  const std::size_t root = formula.size() - 1;
  const Op op = formula.node(root).op;
  if (formula.node(root).is_constant()) return Expression::constant(1);
  if (op == Op::neg) return over_its_factor(subtree(formula, root - 1));
  if (op != Op::mul && op != Op::div) return std::nullopt;
  const Expression right = subtree(formula, root - 1);
  const Expression left = subtree(formula, formula.begin(root - 1) - 1);
  const bool in_left = has_free_constants(left);
  if (in_left == has_free_constants(right) || (op == Op::div && !in_left)) return std::nullopt;
  const std::optional<Expression> rest = over_its_factor(in_left ? left : right);
  if (!rest) return std::nullopt;
  const Expression& other = in_left ? right : left;
  const bool one = rest->size() == 1 && rest->node(0).is_constant();
  if (one && op == Op::mul) return other;
  return in_left ? Expression::binary(op, *rest, other) : Expression::binary(op, other, *rest);
}

struct Addend {
  Expression term;
  bool is_taken_off = false;
};

void add_addends(const Expression& sum, bool is_taken_off, std::vector<Addend>& addends) {
  const std::size_t root = sum.size() - 1;
  const Op op = sum.node(root).op;
  if (op == Op::neg) return add_addends(subtree(sum, root - 1), !is_taken_off, addends);
  if (op != Op::add && op != Op::sub) {
    addends.push_back({sum, is_taken_off});
    return;
  }
  add_addends(subtree(sum, sum.begin(root - 1) - 1), is_taken_off, addends);
  add_addends(subtree(sum, root - 1), is_taken_off != (op == Op::sub), addends);
}

void add_linear_term(BaseModel& base, Expression term) {
  if (std::ranges::count(base.linear_terms, term) == 0) {
    base.linear_terms.push_back(std::move(term));
  }
}

}  // namespace

std::vector<FittedConstant> fitted_constants(const BaseModel& base) {
  const std::vector<std::size_t> all = constant_positions(base.formula);
  const std::vector<std::size_t> free = free_constants(base.formula);
  std::vector<FittedConstant> fitted;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const ConstantRange range = base.ranges.empty() ? ConstantRange() : base.ranges[k];
    if (range.is_fixed() || !std::ranges::binary_search(free, all[k])) continue;
    fitted.push_back({all[k], range});
  }
  return fitted;
}

void add_formula(BaseModel& base, const Expression& formula,
                 std::span<const ConstantRange> ranges) {
  std::vector<Addend> addends;
  add_addends(formula, false, addends);
  std::size_t before = 0;  // constants of the addends so far
  for (const Addend& addend : addends) {
    const std::size_t count = constant_positions(addend.term).size();
    const std::size_t first = std::exchange(before, before + count);
    if (std::optional<Expression> term = over_its_factor(addend.term)) {
      add_linear_term(base, std::move(*term));
      continue;
    }
    if (!ranges.empty()) {
      const auto own = ranges.subspan(first, count);
      base.ranges.insert(base.ranges.end(), own.begin(), own.end());
    }
    if (base.formula.empty()) {
      base.formula = addend.is_taken_off ? Expression::unary(Op::neg, addend.term) : addend.term;
    } else {
      base.formula =
          Expression::binary(addend.is_taken_off ? Op::sub : Op::add, base.formula, addend.term);
    }
  }
}

void add_rigid_terms(BaseModel& base, const Observations& data) {
  const std::vector<std::string> names = data.names();
  for (const std::string& name : data.rigid) {
    if (data.find(name) != nullptr) add_linear_term(base, parse(name, names));
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
  add_formula(base, Expression(std::move(nodes)));
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

std::size_t LoopModel::atoms_of(std::size_t family) const {
  return static_cast<std::size_t>(std::ranges::count(atoms, family, &Atom::family));
}

LoopModel LoopModel::without(std::size_t family) const {
  LoopModel rest = *this;
  for (std::size_t k = rest.atoms.size(); k-- > 0;) {
    if (rest.atoms[k].family == family) rest.remove(k);
  }
  return rest;
}

std::size_t LoopModel::first_column(std::size_t atom) const {
  std::size_t first = base.linear_terms.size();
  for (std::size_t k = 0; k < atom; ++k) first += atoms[k].columns.size();
  return first;
}

Eigen::VectorXd contribution(const LoopModel& model, std::size_t family, const Observations& data) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.rows()));
  for (std::size_t k = 0; k < model.atoms.size(); ++k) {
    const Atom& atom = model.atoms[k];
    if (atom.family != family) continue;
    sum += evaluate_columns(atom.columns, data) *
           model.coefficients.segment(static_cast<Eigen::Index>(model.first_column(k)),
                                      static_cast<Eigen::Index>(atom.columns.size()));
  }
  return sum;
}

std::vector<const Signal*> signals_read(const LoopModel& model, std::size_t family,
                                        const Observations& data) {
  std::vector<const Signal*> all;
  for (const Atom& atom : model.atoms) {
    if (atom.family != family) continue;
    for (const Expression& column : atom.columns) {
      for (const Node& node : column.nodes()) {
        if (!node.is_variable()) continue;
        const Signal* signal = &data.signals[node.variable];
        if (std::ranges::count(all, signal) == 0) all.push_back(signal);
      }
    }
  }
  return all;
}

std::vector<Expression> linear_columns(const LoopModel& model) {
  std::vector<Expression> all = model.base.linear_terms;
  for (const Atom& atom : model.atoms) {
    all.insert(all.end(), atom.columns.begin(), atom.columns.end());
  }
  return all;
}

Eigen::VectorXd evaluate_column(const Expression& formula, const SignalTable& table) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(table.inputs().rows));
  Evaluator().evaluate(formula, table.inputs(), {out.data(), static_cast<std::size_t>(out.size())});
  return out;
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
  if (!model.base.formula.empty()) out = evaluate_column(model.base.formula, SignalTable(data));
  if (model.coefficients.size() > 0) {
    out += evaluate_columns(linear_columns(model), data) * model.coefficients;
  }
  return out;
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
