// SPDX-License-Identifier: MIT
//
// tribench predict: a fitted formula's values on a data file, by the evaluator that judged it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "harness/cli/commands.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"
#include "reports/csv.hpp"
#include "reports/record_csv.hpp"

namespace tribench {
namespace {

// MODEL: a file with the JSON of `fit --json`, or a formula.
std::string formula_of(const std::string& model) {
  std::error_code is_no_path;  // a long formula is none
  if (!std::filesystem::is_regular_file(model, is_no_path)) return model;
  std::ifstream in(model);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("formula") ||
      !json["formula"].is_string()) {
    throw_bad_input("this is no model: it has no formula", model,
                    "give a formula, or what 'tribench fit --json' prints");
  }
  return json["formula"];
}

std::vector<double> predictions(const std::string& model, const Dataset& data) {
  std::vector<std::string> names;
  const std::string text = formula_of(model);
  const Expression formula = parse_collecting_names(text, names);
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  for (const std::string& name : names) columns.push_back(input_values(data, name));
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
  std::vector<double> values(data.rows());
  Evaluator().evaluate(formula, {pointers, data.rows()}, values);
  return values;
}

}  // namespace

void add_predict_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand("predict", "A fitted formula's values on a data file");
  command->footer(
      "Example: tribench fit joint.csv --target tau_f --inputs v,sgn_v --method pysr --json > "
      "m.json"
      "\n         tribench predict m.json later.csv --out predicted.csv");
  auto model = std::make_shared<std::string>();
  auto data = std::make_shared<std::string>();
  auto out = std::make_shared<std::string>();
  command->add_option("MODEL", *model, "what `fit --json` printed, in a file; or a formula")
      ->required();
  command->add_option("DATA", *data, "a CSV file with the formula's columns")->required();
  command->add_option("--out", *out, "the file to write; else to the terminal");
  command->callback([model, data, out] {
    std::string text = "prediction\n";
    for (const double value :
         predictions(*model, read_csv(*data, CsvOptions{.names_tell = false}).data)) {
      text += csv_number(value) + "\n";
    }
    if (out->empty()) {
      std::fputs(text.c_str(), stdout);
    } else {
      write_file(*out, text);
    }
  });
}

}  // namespace tribench
