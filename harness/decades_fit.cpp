// SPDX-License-Identifier: MIT
#include "harness/decades_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "algorithms/admission.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/expression/sum_of_products.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "foundation/elementary.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"
#include "harness/weighted_fit.hpp"

namespace tribench {
namespace {

using build::operator*;
using build::operator-;

constexpr double kDecades = 1.7;  // of the logarithms' standard deviation (docs/settled.md)
constexpr double kVaries = 2;     // of an input: a factor by which a power is none of a line
constexpr double kOfLogarithms = 1.0 / 3;  // of the budget

std::vector<double> logarithms_of(std::span<const double> target) {
  std::vector<double> out;
  for (const double y : target) out.push_back(elementary::log(std::abs(y)));
  return out;
}

CellTask part_of(const CellTask& task, double share) {
  CellTask part = task;
  part.limits.seconds *= share;
  part.limits.evaluations = std::max<std::uint64_t>(
      static_cast<std::uint64_t>(share * static_cast<double>(part.limits.evaluations)), 1);
  return part;
}

// The target in its logarithm, and beside the inputs the logarithms of those that are positive and
// vary by a factor: in these a power is a term of a sum.
struct LogarithmicProblem {
  Problem problem;
  std::vector<Expression> inputs;  // over those of the problem that it comes from

  explicit LogarithmicProblem(const Problem& from) : problem(from) {
    Stage& stage = problem.stages.front();
    Table& table = stage.train;
    table.trail.reset();  // the rows suffice: formulas with states are not looked for here
    table.trail_row.clear();
    table.target = logarithms_of(table.target);
    for (std::size_t j = 0; j < from.inputs.size(); ++j) inputs.push_back(build::input(j));
    for (std::size_t j = 0; j < from.inputs.size(); ++j) {
      const Input& input = from.inputs[j];
      if (!(input.low > 0) || !(input.high > kVaries * input.low)) continue;
      std::string name = "ln_" + input.name;
      while (std::ranges::count(problem.inputs, name, &Input::name) > 0) name += "_";
      stage.inputs.push_back(problem.inputs.size());
      problem.inputs.push_back({name, "-", Role::none, elementary::log(input.low),
                                elementary::log(input.high), std::nullopt});
      table.columns.push_back(logarithms_of(table.columns[j]));
      inputs.push_back(build::function(Op::log, build::input(j)));
    }
    problem.test = table;
  }
};

// exp of a formula, its logarithms as powers and its constant as a factor.
Expression exponential_of(const Expression& formula) {
  Expression product;
  const auto multiply = [&](const Expression& factor) {
    product = product.empty() ? factor : product * factor;
  };
  SumOfProducts rest;
  for (const SumTerm& term : sum_of_products(formula, formula.nodes().size() - 1)) {
    const double factor = elementary::exp(term.coefficient);
    if (term.factors.empty() && factor > 0 && std::isfinite(factor)) {
      multiply(build::constant(factor));
      continue;
    }
    const bool is_alone = term.factors.size() == 1 && term.factors.front().power == 1;
    if (is_alone && term.factors.front().base.nodes().back().op == Op::log) {
      const auto nodes = term.factors.front().base.nodes();
      const Expression argument(std::vector<Node>(nodes.begin(), nodes.end() - 1));
      multiply(build::power(argument, term.coefficient));
      continue;
    }
    rest.push_back(term);
  }
  if (!rest.empty()) multiply(build::function(Op::exp, formula_of(rest)));
  return product.empty() ? build::constant(1) : product;
}

std::vector<Expression> formulas_of(const CellResult& result, const Problem& problem) {
  std::vector<Expression> all;
  for (const FrontRecord& entry : result.front) {
    all.push_back(read_problem_formula(entry.formula, problem).formula);
  }
  return all;
}

}  // namespace

bool lies_over_decades(std::span<const double> target) {
  const auto [least, most] = std::ranges::minmax(target);
  if (!(least > 0) && !(most < 0)) return false;
  const std::vector<double> logs = logarithms_of(target);
  double mean = 0;
  for (const double x : logs) mean += x / static_cast<double>(logs.size());
  double squares = 0;
  for (const double x : logs) squares += (x - mean) * (x - mean);
  return squares > kDecades * kDecades * static_cast<double>(logs.size());
}

CellResult fit_over_decades(const Problem& problem, const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened, std::vector<double>& weights) {
  CellResult result = fit_and_judge(problem, method, part_of(task, 1 - kOfLogarithms), widened);
  if (!is_ok(result.record)) return result;
  const Table& table = problem.stages.front().train;
  const TableInputs inputs(table);
  if (simplest_exact(formulas_of(result, problem), inputs.inputs(), table.target)) return result;
  std::vector<Expression> further;
  if (!result.keeps_form) {
    const LogarithmicProblem searched(problem);
    const CellResult logs =
        fit_and_judge(searched.problem, method, part_of(task, kOfLogarithms), widened);
    if (is_ok(logs.record)) add_costs(result.record, logs.record);
    const InputBox box = input_box(problem.inputs);
    const auto admits = [&](const Expression& one) { return task.operators.admits(one); };
    for (const Expression& formula : formulas_of(logs, searched.problem)) {
      const Expression power = exponential_of(build::substituted(formula, searched.inputs));
      further.push_back(simplify(table.target.front() > 0 ? power : -power, box, admits));
    }
    std::erase_if(further, [&](const Expression& one) { return !admits(one); });
  }
  weights = choose_by_relative_noise(problem, task, result, further);
  return result;
}

}  // namespace tribench
