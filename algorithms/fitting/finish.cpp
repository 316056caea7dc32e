// SPDX-License-Identifier: MIT
#include "algorithms/fitting/finish.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/differences.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/common_multiple.hpp"
#include "algorithms/fitting/named_values.hpp"

namespace tribench {
namespace {

constexpr double kSameError = 1e-9;
constexpr double kRounding = 1e-12;
// Constants are named where the rows are explained to this part of the target's size: beyond it
// noise says nothing about their last digits.
constexpr double kWorthNaming = 1e-5;
// Nodes from which on rewriting costs tenths of a second, and a form is no law's.
constexpr std::size_t kTooLong = 150;
// Of the value; short decimals are near to most numbers at the first.
constexpr double kNearTogether[] = {1e-6, 1e-9};
constexpr double kNearNothing = 1e-9;

std::bitset<kOpCount> operations_of(const Expression& formula) {
  std::bitset<kOpCount> used;
  for (const Node& node : formula.nodes()) used.set(static_cast<std::size_t>(node.op));
  return used;
}

bool has_a_name(double c) {
  const std::vector<double> values = named_values(c);
  return c == 0 || std::ranges::count(values, c) > 0;
}

std::ptrdiff_t numbers_without_a_name(const Expression& formula) {
  return std::ranges::count_if(formula.nodes(), [](const Node& node) {
    return node.is_constant() && !has_a_name(node.value);
  });
}

}  // namespace

FormulaFinisher::FormulaFinisher(const Inputs& inputs, std::span<const double> target, InputBox box,
                                 std::function<bool(const Expression&)> admits)
    : inputs_(inputs),
      target_(target),
      box_(std::move(box)),
      admits_(std::move(admits)),
      values_(target.size()) {
  for (const double y : target_) {
    target_square_ += y * y;
    target_absolute_ += std::abs(y);
  }
}

FormulaFinisher::RowErrors FormulaFinisher::errors_of(const Expression& formula) {
  evaluator_.evaluate(formula, inputs_, values_);
  RowErrors errors;
  for (std::size_t r = 0; r < target_.size(); ++r) {
    const double error = values_[r] - target_[r];
    errors.square += error * error;
    errors.absolute += std::abs(error);
  }
  return errors;
}

// False where either is not finite.
bool FormulaFinisher::is_no_worse(const RowErrors& errors, const RowErrors& than) const {
  return errors.square <= than.square * (1 + kSameError) + kRounding * kRounding * target_square_ &&
         errors.absolute <= than.absolute * (1 + kSameError) + kRounding * target_absolute_;
}

bool FormulaFinisher::is_proved(const Expression& formula) const {
  return prove_free(formula, box_).verdict == Verdict::proved_free;
}

Expression FormulaFinisher::shortest(const Expression& formula) {
  const RowErrors before = errors_of(formula);
  const auto own = operations_of(formula);
  return simplify(formula, box_, [&](const Expression& candidate) {
    const bool is_allowed = admits_(candidate) || (operations_of(candidate) & ~own).none();
    return is_allowed && is_no_worse(errors_of(candidate), before);
  });
}

void FormulaFinisher::fit_the_others(Expression& formula, std::size_t held) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  std::vector<double> low;
  std::vector<double> high;
  bool any_free = false;
  for (const std::size_t p : constant_positions(formula)) {
    if (is_exponent(formula, p)) continue;
    const double c = formula.node(p).value;
    const bool is_held = p == held || has_a_name(c);
    low.push_back(is_held ? c : -kUnbounded);
    high.push_back(is_held ? c : kUnbounded);
    any_free = any_free || !is_held;
  }
  ConstantFitOptions options;
  options.max_iterations = 10;
  options.function_tolerance = 1e-14;
  options.step_tolerance = 1e-15;  // what there is to make good is smaller than usual steps
  options.low = low;
  options.high = high;
  if (any_free) fitter_.fit(formula, inputs_, target_, {}, options);
}

// Accepted where the rows do not mind.
bool FormulaFinisher::try_value(Expression& formula, std::size_t place, double value) {
  const RowErrors before = errors_of(formula);
  Expression candidate = formula;
  set_constant(candidate, place, value);
  // What the others would have to make good must be small, or every constant is fitted to no end.
  const double moved = errors_of(candidate).square;
  if (!(moved <= kNearNamed * kNearNamed * target_square_)) return false;
  fit_the_others(candidate, place);
  if (!is_no_worse(errors_of(candidate), before)) return false;
  formula = std::move(candidate);
  return true;
}

// Where several constants are nearly named, one by one none can be moved: the others were fitted
// beside it. Those that are nearly nothing first go with them, then stay.
void FormulaFinisher::name_together(Expression& formula) {
  for (const double nothing : {kNearNothing, 0.0}) {
    for (const double near : kNearTogether) {
      if (name_all(formula, near, nothing)) return;
    }
  }
}

bool FormulaFinisher::name_all(Expression& formula, double near, double nothing) {
  Expression named = formula;
  for (const std::size_t place : constant_positions(named)) {
    const double c = named.node(place).value;
    if (std::abs(c) < nothing && !is_exponent(named, place)) set_constant(named, place, 0);
    for (const double value : named_values(c)) {
      if (std::abs(c - value) > near * std::abs(value)) continue;
      set_constant(named, place, value);
      break;
    }
  }
  if (named == formula) return false;
  const RowErrors before = errors_of(formula);
  if (!is_no_worse(errors_of(named), before)) fit_the_others(named, named.size());
  if (!is_no_worse(errors_of(named), before)) return false;
  formula = std::move(named);
  return true;
}

// Where the numbers of a sum are known but for a common multiple.
bool FormulaFinisher::take_a_multiple_out(Expression& formula) {
  for (Expression& candidate : with_common_multiple_out(formula)) {
    name_together(candidate);
    Expression shorter = shortest(candidate);
    name_together(shorter);
    if (paper_complexity(shorter) > paper_complexity(formula) ||
        numbers_without_a_name(shorter) >= numbers_without_a_name(formula) ||
        !is_no_worse(errors_of(shorter), errors_of(formula))) {
      continue;
    }
    formula = std::move(shorter);
    return true;
  }
  return false;
}

bool FormulaFinisher::name_a_constant(Expression& formula) {
  for (const std::size_t place : constant_positions(formula)) {
    const double c = formula.node(place).value;
    if (has_a_name(c)) continue;
    for (const double value : named_values(c)) {
      if (try_value(formula, place, value)) return true;
    }
    if (!is_exponent(formula, place) && try_value(formula, place, 0)) return true;
  }
  return false;
}

Expression FormulaFinisher::finish(const Expression& formula) {
  Expression finished = formula.size() > kTooLong ? formula : with_names(formula);
  Expression written = with_differences(finished);
  return admits_(written) ? written : finished;
}

Expression FormulaFinisher::with_names(const Expression& formula) {
  const RowErrors before = errors_of(formula);
  if (!std::isfinite(before.square)) return formula;
  Expression finished = shortest(formula);
  if (before.square > kWorthNaming * kWorthNaming * target_square_) return finished;
  Expression named = finished;
  name_together(named);
  while (take_a_multiple_out(named) || name_a_constant(named)) {
  }
  if (named == finished) return finished;
  named = shortest(named);
  const bool is_as_safe = is_proved(named) || !is_proved(finished);
  return is_as_safe && is_no_worse(errors_of(named), before) ? named : finished;
}

}  // namespace tribench
