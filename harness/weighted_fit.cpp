// SPDX-License-Identifier: MIT
#include "harness/weighted_fit.hpp"

#include <fmt/format.h>

#include <vector>

#include "algorithms/fitting/constant_fit.hpp"
#include "foundation/error.hpp"
#include "harness/judge.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

// Row k is taken as often as points (i + 1/2) / n of the whole weight fall into its part.
std::vector<std::size_t> sampled_rows(std::span<const double> weights) {
  double whole = 0;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    if (!(weights[r] >= 0)) {
      throw_bad_input(fmt::format("the weight of row {} is {}", r + 1, weights[r]), {},
                      "weights are 0 or more; of --sigma, which is above 0, they are 1/sigma^2");
    }
    whole += weights[r];
  }
  if (!(whole > 0)) throw_bad_input("all weights are 0", {}, "give some rows a weight");
  const auto count = static_cast<double>(weights.size());
  std::vector<std::size_t> rows;
  double upto = 0;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    upto += weights[r] / whole * count;
    while (static_cast<double>(rows.size()) + 0.5 < upto && rows.size() < weights.size()) {
      rows.push_back(r);
    }
  }
  return rows;
}

}  // namespace

CellResult fit_weighted(const Problem& problem, std::span<const double> weights,
                        const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened) {
  const Table& table = problem.stages.front().train;
  Problem searched = problem;
  searched.stages.front().train = select_rows(table, sampled_rows(weights));
  CellResult result = fit_and_judge(searched, method, task, widened);
  if (!is_ok(result.record)) return result;
  // A method's formulas have the same states: their columns are those of the chosen one.
  const ProblemFormula own = read_problem_formula(result.record.formula, problem);
  const Problem& judged = own.over(problem);
  std::vector<Expression> front;
  std::size_t chosen = 0;
  ConstantFitter fitter;
  const TableInputs inputs(judged.stages.front().train);
  for (const FrontRecord& entry : result.front) {
    if (entry.chosen) chosen = front.size();
    front.push_back(read_problem_formula(entry.formula, problem).formula);
    fitter.fit(front.back(), inputs.inputs(), table.target, weights);
  }
  judge_formula(judged, {front.at(chosen), {}}, result.record);
  result.front = judge_front(judged, front, chosen, result.record);
  return result;
}

}  // namespace tribench
