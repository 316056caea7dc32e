// SPDX-License-Identifier: MIT
#include "harness/state_refit.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "algorithms/states/state_text.hpp"
#include "algorithms/states/stateful_fit.hpp"
#include "harness/judge.hpp"
#include "harness/stateful_problem.hpp"

namespace tribench {
namespace {

std::vector<const double*> pointers(const std::vector<std::vector<double>>& columns) {
  std::vector<const double*> all;
  for (const std::vector<double>& column : columns) all.push_back(column.data());
  return all;
}

}  // namespace

Problem with_declared_states(const Problem& problem, const std::vector<std::string>& declarations) {
  std::string text;
  for (const std::string& declaration : declarations) text += declaration + "; ";
  const StatefulFormula read = parse_stateful(text + "0", problem.input_names());
  Problem extended = with_states(problem, read.states);
  for (Stage& stage : extended.stages) {
    for (std::size_t k = 0; k < read.states.size(); ++k) {
      stage.inputs.push_back(problem.inputs.size() + k);
    }
  }
  return extended;
}

void refit_states(const Problem& problem, CellResult& result) {
  StatefulFormula formula = parse_stateful(result.record.formula, problem.input_names());
  const Table& train = problem.stages.back().train;
  if (formula.states.empty() || train.trail == nullptr) return;
  const std::vector<const double*> columns = pointers(train.columns);
  const std::vector<const double*> along = pointers(train.trail->columns);
  const StatefulFitFigures figures = fit_stateful(
      formula,
      {columns, train.target, {along, train.trail->time, train.trail->starts}, train.trail_row});
  if (!(figures.after < figures.before)) return;
  const Problem extended = with_states(problem, formula.states);
  judge_formula(extended, {formula.formula, {}}, result.record);
  const auto chosen = std::ranges::find(result.front, true, &FrontRecord::chosen);
  if (chosen == result.front.end()) return;
  *chosen = judge_front(extended, {formula.formula}, 0, result.record).front();
}

}  // namespace tribench
