// SPDX-License-Identifier: MIT
#include "harness/weighted_fit.hpp"

#include <fmt/format.h>

#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "foundation/error.hpp"
#include "harness/judge.hpp"
#include "harness/table_evaluator.hpp"

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

Table rows_of(const Table& table, const std::vector<std::size_t>& rows) {
  Table taken;
  for (const std::vector<double>& column : table.columns) {
    std::vector<double>& values = taken.columns.emplace_back();
    for (const std::size_t r : rows) values.push_back(column[r]);
  }
  for (const std::size_t r : rows) {
    taken.target.push_back(table.target[r]);
    taken.movement.push_back(table.movement[r]);
  }
  return taken;
}

}  // namespace

CellResult fit_weighted(const Problem& problem, std::span<const double> weights,
                        const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened) {
  const Table& table = problem.stages.front().train;
  Problem searched = problem;
  searched.stages.front().train = rows_of(table, sampled_rows(weights));
  CellResult result = fit_and_judge(searched, method, task, widened);
  if (result.record.status != "ok") return result;
  std::vector<Expression> front;
  std::size_t chosen = 0;
  ConstantFitter fitter;
  const TableInputs inputs(table);
  for (const FrontRecord& entry : result.front) {
    if (entry.chosen) chosen = front.size();
    front.push_back(parse(entry.formula, problem.input_names()));
    fitter.fit(front.back(), inputs.inputs(), table.target, weights);
  }
  judge_formula(problem, {front.at(chosen), {}}, result.record);
  result.front = judge_front(problem, front, chosen, result.record);
  return result;
}

}  // namespace tribench
