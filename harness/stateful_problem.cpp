// SPDX-License-Identifier: MIT
#include "harness/stateful_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_column.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

std::string free_name(const Problem& problem, const std::string& wanted) {
  std::string name = wanted;
  for (int k = 2; std::ranges::find(problem.inputs, name, &Input::name) != problem.inputs.end();
       ++k) {
    name = fmt::format("{}{}", wanted, k);
  }
  return name;
}

Input input_of(const Problem& problem, const StateDeclaration& state) {
  std::vector<StateRange> drives;
  for (const std::size_t drive : state.drives) {
    drives.push_back({problem.inputs[drive].low, problem.inputs[drive].high});
  }
  const StateRange range = state_range(state.law, state.parameters, drives);
  Input input;
  input.name = free_name(problem, state.name);
  input.unit = "-";
  input.low = range.low;
  input.high = range.high;
  input.law = print_state_law(state, problem.input_names());
  return input;
}

void add_column(const Problem& problem, const StateDeclaration& state, Table& table) {
  if (table.rows() == 0) {
    table.columns.emplace_back();
    return;
  }
  if (table.trail == nullptr) {
    throw_bad_input("a formula with memory needs time", problem.name,
                    "say which column is time (--roles COLUMN=time)");
  }
  std::vector<const double*> columns;
  for (const std::vector<double>& column : table.trail->columns) columns.push_back(column.data());
  std::vector<double> whole(table.trail->time.size());
  state_column(state, {columns, table.trail->time, table.trail->starts}, whole);
  std::vector<double>& taken = table.columns.emplace_back();
  taken.reserve(table.rows());
  for (const std::size_t row : table.trail_row) taken.push_back(whole[row]);
}

// States stand behind all other inputs.
Problem without_states(Problem problem) {
  const auto keep = [](auto& columns, std::size_t count) {
    if (columns.size() > count) columns.resize(count);
  };
  const auto first =
      std::ranges::find_if(problem.inputs, [](const Input& input) { return !input.law.empty(); });
  const auto count = static_cast<std::size_t>(first - problem.inputs.begin());
  keep(problem.inputs, count);
  for (Stage& stage : problem.stages) {
    std::erase_if(stage.inputs, [count](std::size_t place) { return place >= count; });
    keep(stage.train.columns, count);
  }
  keep(problem.test.columns, count);
  return problem;
}

}  // namespace

Problem with_states(const Problem& problem, std::span<const StateDeclaration> states) {
  Problem extended = problem;
  for (const StateDeclaration& state : states) {
    check_state(state, problem.inputs.size());
    extended.inputs.push_back(input_of(extended, state));
    for (Stage& stage : extended.stages) add_column(problem, state, stage.train);
    add_column(problem, state, extended.test);
  }
  return extended;
}

std::string formula_text(const Problem& problem, const Expression& formula) {
  std::string text;
  for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
    const Input& input = problem.inputs[j];
    if (input.law.empty()) continue;
    const bool is_read = std::ranges::any_of(formula.nodes(), [j](const Node& node) {
      return node.is_variable() && node.variable == j;
    });
    if (is_read) text += fmt::format("{} = {}; ", input.name, input.law);
  }
  return text + print(formula, problem.input_names());
}

ProblemFormula read_problem_formula(const std::string& text, const Problem& problem) {
  const Problem measured = without_states(problem);
  StatefulFormula read = parse_stateful(text, measured.input_names());
  ProblemFormula result{std::move(read.formula), std::nullopt};
  if (!read.states.empty()) result.extended = with_states(measured, read.states);
  return result;
}

}  // namespace tribench
