// SPDX-License-Identifier: MIT
#include "algorithms/fitting/common_multiple.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/sum_of_products.hpp"
#include "algorithms/fitting/named_values.hpp"

namespace tribench {
namespace {

using namespace build;

constexpr double kNearAName = 1e-6;  // of the value, and of 1: large whole numbers are near to all
constexpr double kNextToNothing = 1e-9;

bool is_nearly_named(double c) {
  const auto is_near = [c](double name) {
    return std::abs(c - name) <= kNearAName * std::min(std::abs(name), 1.0);
  };
  return std::abs(c) <= kNextToNothing || std::ranges::any_of(named_values(c), is_near);
}

// A formula times a number, the number within the constants that are there: times 1/2 is
// 2 x (y + 4) the same as x (y + 4), and 4 + 6 x the same as 2 + 3 x.
class Multiple {
 public:
  Multiple(const Expression& formula, double factor) : formula_(formula), factor_(factor) {}

  Expression of(std::size_t i) {
    const Node& node = formula_.node(i);
    if (node.is_constant()) return number(node.value);
    if (is_sum(node.op)) {
      Expression left = of(formula_.left_child(i));
      return Expression::binary(node.op, left, of(formula_.last_child(i)));
    }
    if (node.op == Op::neg) return -of(formula_.last_child(i));
    if (node.op == Op::mul || node.op == Op::div) {
      const std::size_t left = formula_.left_child(i);
      const std::size_t right = formula_.last_child(i);
      if (holds_a_number(left)) {
        return Expression::binary(node.op, of(left), subtree(formula_, right));
      }
      if (node.op == Op::mul && holds_a_number(right)) return subtree(formula_, left) * of(right);
    }
    return number(1) * subtree(formula_, i);
  }

  // That stand before the terms now, 1 included.
  std::span<const double> numbers() const { return numbers_; }

 private:
  Expression number(double c) {
    numbers_.push_back(c * factor_);
    return constant(c * factor_);
  }

  bool holds_a_number(std::size_t i) const {
    const Op op = formula_.node(i).op;
    if (op == Op::constant || is_sum(op)) return true;
    if (op == Op::neg) return holds_a_number(formula_.last_child(i));
    if (op == Op::mul) {
      return holds_a_number(formula_.left_child(i)) || holds_a_number(formula_.last_child(i));
    }
    return op == Op::div && holds_a_number(formula_.left_child(i));
  }

  const Expression& formula_;
  double factor_;
  std::vector<double> numbers_;
};

// The formula with the sum at i as k times what it is divided by k.
Expression with_number_out(const Expression& formula, std::size_t i, double k,
                           const Expression& divided) {
  std::size_t place = i;
  Expression instead = constant(k) * divided;
  const std::size_t parent = parent_of(formula, i);
  if (parent < formula.size() && k > 0) {
    const Op op = formula.node(parent).op;
    const bool is_base = op == Op::pow && is_exponent(formula, formula.last_child(parent));
    if (op == Op::sqrt) {
      place = parent;
      instead = constant(std::sqrt(k)) * function(Op::sqrt, divided);
    } else if (is_base) {
      const double exponent = formula.node(formula.last_child(parent)).value;
      place = parent;
      instead = constant(apply(Op::pow, k, exponent)) * power(divided, exponent);
    }
  }
  Expression result = formula;
  result.replace(place, instead.nodes());
  return result;
}

}  // namespace

std::vector<Expression> with_common_multiple_out(const Expression& formula) {
  std::vector<Expression> found;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!is_sum(formula.node(i).op)) continue;
    const std::size_t parent = parent_of(formula, i);
    if (parent < formula.size() && is_sum(formula.node(parent).op)) continue;
    Multiple itself(formula, 1);
    itself.of(i);
    if (std::ranges::all_of(itself.numbers(), is_nearly_named)) continue;
    std::vector<double> tried;
    for (const double k : itself.numbers()) {
      if (k == 0 || std::abs(k) == 1 || std::ranges::count(tried, std::abs(k)) > 0) continue;
      tried.push_back(std::abs(k));
      Multiple divided(formula, 1 / std::abs(k));
      const Expression sum = divided.of(i);
      if (!std::ranges::all_of(divided.numbers(), is_nearly_named)) continue;
      found.push_back(with_number_out(formula, i, std::abs(k), sum));
    }
  }
  return found;
}

}  // namespace tribench
