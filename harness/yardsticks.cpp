// SPDX-License-Identifier: MIT
#include "harness/yardsticks.hpp"

#include <span>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "harness/metrics.hpp"
#include "harness/table_evaluator.hpp"

namespace tribench {
namespace {

// Starts at the true constants, so that the minimum found is theirs.
Expression refit_law(const Problem& problem) {
  const ConstantFitOptions to_convergence{.max_iterations = 100, .function_tolerance = 1e-12};
  const std::vector<std::string> names = problem.input_names();
  TableEvaluator evaluator;
  Expression whole;
  for (const Stage& stage : problem.stages) {
    std::vector<double> left = stage.train.target;
    if (!whole.empty()) {
      const std::span<const double> explained = evaluator.evaluate(whole, stage.train);
      for (std::size_t r = 0; r < left.size(); ++r) left[r] -= explained[r];
    }
    Expression law = parse(stage.law, names);
    ConstantFitter().fit(law, TableInputs(stage.train).inputs(), left, {}, to_convergence);
    whole = whole.empty() ? law : Expression::binary(Op::add, whole, law);
  }
  return whole;
}

}  // namespace

Yardsticks measure_yardsticks(const Problem& problem) {
  Yardsticks yardsticks;
  const Table& test = problem.test;
  if (!test.truth.empty()) yardsticks.ceiling = compute_errors(test.truth, test.target).mae;
  const std::string law = problem.true_law();
  if (law.empty()) return yardsticks;
  TableEvaluator evaluator;
  const Expression known = parse(law, problem.input_names());
  yardsticks.law = compute_errors(evaluator.evaluate(known, test), test.target).mae;
  const Expression refitted = refit_law(problem);
  const std::span<const double> values = evaluator.evaluate(refitted, test);
  yardsticks.refitted = compute_errors(values, test.target).mae;
  if (!test.truth.empty()) yardsticks.truth_refitted = compute_errors(values, test.truth).mae;
  return yardsticks;
}

}  // namespace tribench
