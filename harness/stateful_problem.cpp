// SPDX-License-Identifier: MIT
#include "harness/stateful_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
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

// The trails of a problem's tables with the states' columns behind those of the inputs: a method
// that knows friction with memory reads every input along them. Tables of one trail share one.
class StateTrails {
 public:
  explicit StateTrails(const Problem& problem) : problem_(problem) {}

  void add(const StateDeclaration& state) { states_.push_back(&state); }

  // Gives the table the states' columns; rows of a problem without time have none.
  void extend(Table& table) {
    if (table.rows() == 0) {
      table.columns.resize(table.columns.size() + states_.size());
      return;
    }
    if (table.trail == nullptr) {
      throw_bad_input("a formula with memory needs time", problem_.name,
                      "say which column is time (--roles COLUMN=time)");
    }
    table.trail = extended(table.trail);
    for (std::size_t k = 0; k < states_.size(); ++k) {
      const std::vector<double>& whole = table.trail->columns[problem_.inputs.size() + k];
      std::vector<double>& taken = table.columns.emplace_back();
      taken.reserve(table.rows());
      for (const std::size_t row : table.trail_row) taken.push_back(whole[row]);
    }
  }

 private:
  std::shared_ptr<const Trail> extended(const std::shared_ptr<const Trail>& trail) {
    std::shared_ptr<const Trail>& known = extended_[trail.get()];
    if (known != nullptr) return known;
    auto made = std::make_shared<Trail>(*trail);
    made->columns.resize(problem_.inputs.size());  // states that it had then go
    std::vector<const double*> columns;
    for (const std::vector<double>& column : made->columns) columns.push_back(column.data());
    for (const StateDeclaration* state : states_) {
      std::vector<double> whole(made->time.size());
      state_column(*state, {columns, made->time, made->starts}, whole);
      made->columns.push_back(std::move(whole));
    }
    return known = std::move(made);
  }

  const Problem& problem_;
  std::vector<const StateDeclaration*> states_;
  std::map<const Trail*, std::shared_ptr<const Trail>> extended_;
};

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
  StateTrails trails(problem);
  for (const StateDeclaration& state : states) {
    check_state(state, problem.inputs.size());
    extended.inputs.push_back(input_of(extended, state));
    trails.add(state);
  }
  if (states.empty()) return extended;
  for (Stage& stage : extended.stages) trails.extend(stage.train);
  trails.extend(extended.test);
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
