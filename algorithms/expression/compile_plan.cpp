// SPDX-License-Identifier: MIT
#include "algorithms/expression/compile_plan.hpp"

#include <algorithm>

#include "algorithms/expression/evaluate.hpp"

namespace tribench::compile {
namespace {

bool runs_in_a_kernel(const Expression& formula, std::size_t i) {
  switch (formula.node(i).op) {
    case Op::exp:
    case Op::log:
    case Op::sgn:
    case Op::sin:
    case Op::cos:
    case Op::tanh:
    case Op::atan:
      return true;
    case Op::pow:
      return !is_whole_power(formula, i);
    default:
      return false;
  }
}

class Planner {
 public:
  explicit Planner(const Expression& formula) : formula_(formula) {}

  Plan run() {
    plan_.nodes.resize(formula_.size());
    number_columns();
    for (std::size_t i = 0; i < formula_.size(); ++i) place(i);
    const std::size_t root = formula_.root();
    if (plan_.nodes[root].place == Place::buffer) {
      plan_.steps.back().out = kResult;
    } else {
      plan_.steps.push_back({Step::Kind::region, root, kResult});
    }
    return std::move(plan_);
  }

 private:
  void number_columns() {
    for (const Node& node : formula_.nodes()) {
      if (node.is_variable()) plan_.columns.push_back(node.variable);
    }
    std::sort(plan_.columns.begin(), plan_.columns.end());
    plan_.columns.erase(std::unique(plan_.columns.begin(), plan_.columns.end()),
                        plan_.columns.end());
    plan_.operands = static_cast<std::uint32_t>(plan_.columns.size());
  }

  void place(std::size_t i) {
    const Node& node = formula_.node(i);
    NodePlan& here = plan_.nodes[i];
    if (node.is_variable()) {
      here.place = Place::column;
      here.index = static_cast<std::uint32_t>(
          std::lower_bound(plan_.columns.begin(), plan_.columns.end(), node.variable) -
          plan_.columns.begin());
      return;
    }
    if (is_scalar(i)) {
      here.place = Place::scalar;
      here.index = static_cast<std::uint32_t>(plan_.scalars.size());
      plan_.scalars.push_back(i);
    } else if (runs_in_a_kernel(formula_, i)) {
      place_kernel(i);
    } else {
      here.registers = registers_needed(i);
    }
  }

  bool is_scalar(std::size_t i) const {
    const Node& node = formula_.node(i);
    if (node.is_constant()) return true;
    if (plan_.nodes[formula_.last_child(i)].place != Place::scalar) return false;
    return arity(node.op) == 1 || plan_.nodes[formula_.left_child(i)].place == Place::scalar;
  }

  // The kernel's operands must be columns, buffers or scalars: arithmetic below it is a region.
  void place_kernel(std::size_t i) {
    if (arity(formula_.node(i).op) == 2) settle(formula_.left_child(i));
    settle(formula_.last_child(i));
    const bool is_power = formula_.node(i).op == Op::pow;
    add_step(is_power ? Step::Kind::power : Step::Kind::function, i);
  }

  void settle(std::size_t i) {
    if (plan_.nodes[i].place == Place::computed) add_step(Step::Kind::region, i);
  }

  // Its result may overwrite a buffer that it reads: row by row, reading comes first.
  void add_step(Step::Kind kind, std::size_t i) {
    const auto first = std::lower_bound(live_.begin(), live_.end(), formula_.begin(i));
    const auto last = std::upper_bound(first, live_.end(), i);
    for (auto it = first; it != last; ++it) free_.push_back(plan_.nodes[*it].index);
    live_.insert(live_.erase(first, last), i);
    if (free_.empty()) free_.push_back(plan_.operands++);
    plan_.nodes[i].place = Place::buffer;
    plan_.nodes[i].index = free_.back();
    plan_.steps.push_back({kind, i, free_.back()});
    free_.pop_back();
  }

  std::uint16_t registers_needed(std::size_t i) const {
    const Node& node = formula_.node(i);
    const NodePlan& right = plan_.nodes[formula_.last_child(i)];
    if (arity(node.op) == 1) return right.registers;
    const NodePlan& left = plan_.nodes[formula_.left_child(i)];
    // A power keeps the square beside the product; a leaf needs a register to be brought in.
    if (node.op == Op::pow) return static_cast<std::uint16_t>(std::max<int>(left.registers, 2));
    const std::uint16_t most = std::max(left.registers, right.registers);
    return left.registers == right.registers ? static_cast<std::uint16_t>(most + 1)
                                             : std::max<std::uint16_t>(most, 2);
  }

  const Expression& formula_;
  Plan plan_;
  std::vector<std::size_t> live_;    // nodes whose buffers are still to be read, sorted
  std::vector<std::uint32_t> free_;  // buffers that were read
};

}  // namespace

bool is_whole_power(const Expression& formula, std::size_t i) {
  const Node& exponent = formula.node(formula.last_child(i));
  return exponent.is_constant() && is_product_power(exponent.value);
}

Plan make_plan(const Expression& formula) { return Planner(formula).run(); }

}  // namespace tribench::compile
