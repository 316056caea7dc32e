// SPDX-License-Identifier: MIT
#include "algorithms/expression/derivative_plan.hpp"

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

bool is_whole_power(const Node& exponent) {
  return exponent.is_constant() && is_product_power(exponent.value);
}

}  // namespace

void DerivativePlan::prepare(const Expression& formula, std::span<const std::size_t> constants) {
  parameter_count_ = constants.size();
  leaves_.clear();
  for (std::size_t k = 0; k < constants.size(); ++k) {
    leaves_.push_back({static_cast<std::uint32_t>(constants[k]), static_cast<std::uint32_t>(k)});
  }
  compile(formula);
}

void DerivativePlan::prepare_for_inputs(const Expression& formula, std::size_t inputs) {
  parameter_count_ = inputs;
  leaves_.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (!node.is_variable() || node.variable >= inputs) continue;
    leaves_.push_back({static_cast<std::uint32_t>(i), node.variable});
  }
  compile(formula);
}

void DerivativePlan::compile(const Expression& formula) {
  steps_.assign(formula.size(), Step{});
  scalars_.assign(formula.size(), 0);
  for (const Leaf& leaf : leaves_) steps_[leaf.place].wanted = true;
  stack_.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    Step& step = steps_[i];
    step.op = node.op;
    if (node.is_constant()) {
      scalars_[i] = node.value;
    } else if (node.is_variable()) {
      step.kind = Kind::column;
      step.a = node.variable;
    } else {
      if (arity(node.op) == 2) {
        step.b = stack_.back();
        stack_.pop_back();
      } else {
        step.b = stack_.back();
      }
      step.a = stack_.back();
      stack_.pop_back();
      const Step& a = steps_[step.a];
      const Step& b = steps_[step.b];
      step.kind = a.kind == Kind::column ? Kind::column : b.kind;
      step.wanted = (a.wanted || b.wanted) && node.op != Op::sgn;
      if (node.op == Op::pow && !b.wanted && is_whole_power(formula.node(step.b))) {
        step.whole_power = true;
        step.exponent = static_cast<int>(formula.node(step.b).value);
      }
    }
    stack_.push_back(static_cast<std::uint32_t>(i));
  }
  // Downwards: what lies below a sgn is not reached.
  for (std::size_t i = formula.size(); i-- > 0;) {
    const Step& step = steps_[i];
    if (step.wanted || arity(step.op) == 0) continue;
    steps_[step.a].wanted = false;
    steps_[step.b].wanted = false;
  }
  assign_slots();
}

void DerivativePlan::assign_slots() {
  slot_count_ = 0;
  const auto next = [this] { return static_cast<std::uint32_t>(slot_count_++); };
  for (Step& step : steps_) {
    if (step.kind == Kind::column && step.op != Op::variable) step.value_slot = next();
  }
  for (Step& step : steps_) {
    if (step.wanted) step.adjoint_slot = next();
  }
}

void DerivativePlan::set_constants(std::span<const double> values) {
  for (const Leaf& leaf : leaves_) scalars_[leaf.place] = values[leaf.parameter];
}

void DerivativePlan::compute_scalars() {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.kind != Kind::scalar || step.op == Op::constant) continue;
    const double a = scalars_[step.a];
    scalars_[i] = arity(step.op) == 1 ? apply(step.op, a) : apply(step.op, a, scalars_[step.b]);
  }
}

}  // namespace tribench
