// SPDX-License-Identifier: MIT
//
// tribench predict: a fitted formula's values on a data file, by the evaluator that judged it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/states/state_column.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/fit_output.hpp"
#include "harness/cli/model_argument.hpp"
#include "problems/preparation/data_options.hpp"
#include "problems/table.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

constexpr std::string_view kSign = "sgn_";

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

// A formula's sgn_X is the sign of X, as in proofs and exported code. A model may have been fitted
// to a column of that name without X, which may hold anything.
std::vector<std::string> names_of_signs(const std::vector<std::string>& names,
                                        const nlohmann::json& model) {
  const nlohmann::json inputs = model.value("inputs", nlohmann::json());
  const auto is_input = [&](std::string_view name) {
    return std::ranges::any_of(inputs, [name](const nlohmann::json& input) {
      return input.is_string() && input.get_ref<const std::string&>() == name;
    });
  };
  std::vector<std::string> signs;
  for (const std::string& name : names) {
    if (!name.starts_with(kSign)) continue;
    const bool is_by_itself =
        is_input(name) && !is_input(std::string_view(name).substr(kSign.size()));
    if (!is_by_itself) signs.push_back(name);
  }
  return signs;
}

// Beside X in the file it has to be its sign, alone in it -1, 0 or 1.
void require_signs_in(const Dataset& data, const std::vector<std::string>& signs,
                      const std::string& file, const DataOptions& options) {
  const ChannelIndex channels(data);
  for (const std::string& name : signs) {
    const Channel* given = channels.find(name);
    if (given == nullptr) continue;  // derived
    const std::string of = name.substr(kSign.size());
    if (channels.find(of) != nullptr) {
      require_signs(data, std::vector<std::string>{of, name});
      continue;
    }
    const auto is_sign = [](double value) { return value == 0 || std::abs(value) == 1; };
    const auto wrong = std::ranges::find_if_not(given->values, is_sign);
    if (wrong == given->values.end()) continue;
    const std::string words = fmt::format("{} stands for the sign of {}: -1, 0 or 1", name, of);
    require_rule(file, options, {name, is_sign, words});
    throw_bad_input(fmt::format("'{}' is {} in a row", name, *wrong), file, words);
  }
}

struct PredictArguments {
  std::string model;
  std::string data;
  std::string out;
  std::string time;
  bool intervals = false;
  bool is_told = false;  // how the data are to be read; else as those of the fit
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
};

// A blank line would be no row to a reader, and every later prediction would move up.
std::string prediction_text(double value) {
  return std::isnan(value) ? std::string("nan") : csv_number(value);
}

std::string predictions(const PredictArguments& arguments) {
  const std::string& file = arguments.model;
  const bool intervals = arguments.intervals;
  const nlohmann::json model = model_argument(file);
  std::vector<std::string> names;
  const StatefulFormula read =
      parse_stateful_collecting(model["formula"].get<std::string>(), names);
  DataOptions options = arguments.is_told ? *arguments.reading : read_fit_reading(model, file);
  if (!arguments.time.empty()) options.roles[arguments.time] = Role::time;
  std::vector<std::string> used = names;
  for (const auto& [column, given] : options.roles) {
    if (given.role == Role::time) used.push_back(column);
  }
  Dataset data = read_columns(arguments.data, options, std::move(used));
  data.name = arguments.data;  // in messages
  const Expression& formula = read.formula;
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  require_signs_in(data, names_of_signs(names, model), arguments.data, options);
  const ChannelIndex channels(data);
  for (const std::string& name : names) columns.push_back(input_values(channels, name));
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
    text += prediction_text(values[r]);
    if (intervals) {
      text += "," + prediction_text(values[r] - halves[r]) + "," +
              prediction_text(values[r] + halves[r]);
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
      "\n         tribench predict m.json later.csv --out predicted.csv"
      "\nThe data are read as those that a model was fitted to, its --roles and all, unless "
      "options here say how. Where the formula has no finite value the line is nan, inf or -inf.");
  auto arguments = std::make_shared<PredictArguments>();
  command
      ->add_option("MODEL", arguments->model, "what `fit --json` printed, in a file; or a formula")
      ->required();
  command->add_option("DATA", arguments->data, "a CSV file with the formula's columns")->required();
  command->add_option("--out", arguments->out, "the file to write; else to the terminal");
  command->add_flag("--intervals", arguments->intervals,
                    "with a model of `fit --save`: 95 % of the curve, as columns low and high");
  command->add_option("--time", arguments->time,
                      "the column of time (s), for a formula with states");
  const std::size_t own = command->get_options().size();
  add_data_options(*command, arguments->reading);
  const std::vector<CLI::Option*> options = command->get_options();
  const std::vector<CLI::Option*> telling(options.begin() + static_cast<std::ptrdiff_t>(own),
                                          options.end());
  command->callback([arguments, telling] {
    arguments->is_told =
        std::ranges::any_of(telling, [](const CLI::Option* option) { return option->count() > 0; });
    const std::string text = predictions(*arguments);
    if (arguments->out.empty()) {
      std::fputs(text.c_str(), stdout);
    } else {
      write_file(arguments->out, text);
    }
  });
}

}  // namespace tribench
