// SPDX-License-Identifier: MIT
//
// Runs a method on a problem's training rows, as a cell does, for tests.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "algorithms/registry.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::testing {

// Owns what a FitContext looks at: the stage's inputs and rows.
struct Training {
  std::vector<Input> inputs;
  std::vector<const double*> columns;
  std::vector<const double*> trail;
  const Table* table = nullptr;

  explicit Training(const Problem& problem, std::size_t stage = 0)
      : table(&problem.stages[stage].train) {
    for (std::size_t j : problem.stages[stage].inputs) {
      inputs.push_back(problem.inputs[j]);
      columns.push_back(table->columns[j].data());
      if (table->trail != nullptr) trail.push_back(table->trail->columns[j].data());
    }
  }
  TrainingData data() const {
    TrainingData data{inputs, columns, table->target, table->movement};
    if (table->trail == nullptr) return data;
    data.motion = {trail, table->trail->time, table->trail->starts};
    data.motion_row = table->trail_row;
    return data;
  }
};

struct FitOptions {
  std::map<std::string, ParameterValue> parameters = {};
  std::string operators = "paper";
  std::uint64_t seed = 1;
  BudgetLimits limits = {};
  int threads = 1;
};

inline FitResult run_fit(const TrainingData& data, const std::string& algorithm,
                         const FitOptions& options = {}) {
  Budget budget(options.limits);
  FitContext context{data, find_operator_set(options.operators), budget, RandomStream(options.seed),
                     options.threads};
  return Registry().make(algorithm, options.parameters)->fit(context);
}

inline double mean_absolute_error(const Expression& formula, const TrainingData& data,
                                  std::span<const double> reference) {
  std::vector<double> values(data.rows());
  Evaluator().evaluate(formula, data.table(), values);
  double sum = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    sum += std::abs(values[row] - reference[row]);
  }
  return sum / static_cast<double>(values.size());
}

}  // namespace tribench::testing
