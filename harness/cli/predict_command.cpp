// SPDX-License-Identifier: MIT
//
// tribench predict: a fitted formula's values on a data file, by the evaluator that judged it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/states/state_column.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/fit_output.hpp"
#include "harness/cli/model_argument.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

// Behind the inputs' columns.
void add_state_columns(const StatefulFormula& formula, const Dataset& data,
                       std::vector<std::vector<double>>& columns) {
  if (formula.states.empty()) return;
  const Channel* time = data.find(Role::time);
  if (time == nullptr) {
    throw_bad_input("the formula has states, and no column is time", data.name,
                    "say which one is: --time COLUMN");
  }
  const std::vector<std::size_t> starts = run_starts(time->values);
  std::vector<const double*> inputs;
  for (const std::vector<double>& column : columns) inputs.push_back(column.data());
  std::vector<std::vector<double>> states;
  for (const StateDeclaration& state : formula.states) {
    states.emplace_back(data.rows());
    state_column(state, {inputs, time->values, starts}, states.back());
  }
  std::ranges::move(states, std::back_inserter(columns));
}

std::string predictions(const std::string& file, const Dataset& data, bool intervals) {
  const nlohmann::json model = model_argument(file);
  std::vector<std::string> names;
  const StatefulFormula read =
      parse_stateful_collecting(model["formula"].get<std::string>(), names);
  const Expression& formula = read.formula;
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  for (const std::string& name : names) columns.push_back(input_values(data, name));
  add_state_columns(read, data, columns);
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
  std::vector<double> values(data.rows());
  const Inputs inputs{pointers, data.rows()};
  Evaluator().evaluate(formula, inputs, values);
  std::vector<double> halves;
  if (intervals) {
    const FitIntervals kept = read_fit_intervals(model, formula, file);
    halves = curve_half_widths(formula, kept, inputs);
  }
  std::string text = intervals ? "prediction,low,high\n" : "prediction\n";
  for (std::size_t r = 0; r < values.size(); ++r) {
    text += csv_number(values[r]);
    if (intervals) {
      text += "," + csv_number(values[r] - halves[r]) + "," + csv_number(values[r] + halves[r]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

void add_predict_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("predict", "A fitted formula's values on a data file");
  command->footer(
      "Example: tribench fit joint.csv --target tau_f --inputs v,sgn_v --method pysr --save "
      "m.json"
      "\n         tribench predict m.json later.csv --out predicted.csv");
  auto model = std::make_shared<std::string>();
  auto data = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  command->add_option("MODEL", *model, "what `fit --json` printed, in a file; or a formula")
      ->required();
  command->add_option("DATA", *data, "a CSV file with the formula's columns")->required();
  command->add_option("--out", *out, "the file to write; else to the terminal");
  auto intervals = std::make_shared<bool>(false);
  command->add_flag("--intervals", *intervals,
                    "with a model of `fit --save`: 95 % of the curve, as columns low and high");
  auto time = std::make_shared<std::string>();
  command->add_option("--time", *time, "the column of time (s), for a formula with states");
  command->callback([model, data, out, intervals, time] {
    CsvOptions options;
    options.names_tell = false;
    if (!time->empty()) options.roles[*time] = Role::time;
    const std::string text = predictions(*model, read_csv(*data, options).data, *intervals);
    if (out->empty()) {
      std::fputs(text.c_str(), stdout);
    } else {
      write_file(*out, text);
    }
  });
}

}  // namespace tribench
