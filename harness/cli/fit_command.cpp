// SPDX-License-Identifier: MIT
//
// tribench fit: one method on the user's own data.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/machine.hpp"
#include "harness/run_cell.hpp"
#include "problems/data_problem.hpp"

namespace tribench {
namespace {

struct FitArguments {
  std::string data;
  std::string target;
  std::vector<std::string> inputs;
  std::string method;
  std::string operators = "paper";
  std::vector<std::string> parameters;  // name=value
  std::uint64_t seed = 1;
  std::uint64_t evaluations = 2'000'000'000;
  double seconds = 60;
  bool spends_all = false;  // seconds were asked for
  std::string test;
  std::shared_ptr<DataOptions> reading = std::make_shared<DataOptions>();
  bool json = false;
};

// "a=b" as a pair.
std::pair<std::string, std::string> name_and_value(const std::string& text, const char* option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw_bad_input(fmt::format("'{}' is not name=value", text), option);
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// A column is what --inputs and --target say; its name means nothing.
Dataset read_columns(const std::string& file, const FitArguments& arguments) {
  std::vector<std::string> used = arguments.inputs;
  used.push_back(arguments.target);
  const std::vector<std::filesystem::path> files = {file};
  DataFile reading = read_named_columns(files, *arguments.reading, std::move(used));
  for (const std::string& warning : reading.warnings) {
    fmt::print(stderr, "tribench: {}\n", warning);
  }
  if (reading.dropped_rows > 0) {
    fmt::print(stderr, "tribench: {}: {} rows with missing values dropped\n", file,
               reading.dropped_rows);
  }
  return std::move(reading.data);
}

CellTask task_of(const FitArguments& arguments, const Problem& problem, bool fixed_form) {
  CellTask task;
  task.cell = {problem.name, arguments.method, fixed_form ? kFixedForm : arguments.operators,
               arguments.seed};
  task.operators = find_operator_set(arguments.operators);
  if (fixed_form) task.operators = fixed_form_operators();
  task.limits.evaluations = arguments.evaluations;
  task.limits.seconds = arguments.seconds;
  task.spends_all = arguments.spends_all;
  task.threads = usable_processors();
  return task;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void print_json(const CellResult& result) {
  const Record& record = result.record;
  nlohmann::ordered_json front = nlohmann::ordered_json::array();
  for (const FrontRecord& entry : result.front) {
    front.push_back({{"formula", entry.formula},
                     {"complexity", entry.complexity},
                     {"mae_train", number(entry.mae_train)},
                     {"mae_test", number(entry.mae_test)},
                     {"singularity", entry.singularity}});
  }
  nlohmann::ordered_json all = {{"formula", record.formula},
                                {"complexity", record.complexity},
                                {"nodes", record.nodes},
                                {"mae_train", number(record.mae_train)},
                                {"mae_test", number(record.mae_test)},
                                {"evaluations", record.evaluations},
                                {"fit_cpu_s", number(record.fit_cpu_s)},
                                {"singularity", record.singularity}};
  if (!record.witness.empty()) all["witness"] = nlohmann::json::parse(record.witness);
  if (!record.note.empty()) all["note"] = record.note;
  all["front"] = front;
  fmt::print("{}\n", all.dump(2));
}

std::string figure(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("-");
}

void print_text(const CellResult& result) {
  fmt::print("  complexity     MAE train      MAE test  singularity  formula\n");
  for (const FrontRecord& entry : result.front) {
    fmt::print("{} {:10}  {:>12}  {:>12}  {:11}  {}\n", entry.chosen ? '*' : ' ', entry.complexity,
               figure(entry.mae_train), figure(entry.mae_test), entry.singularity, entry.formula);
  }
  const Record& record = result.record;
  fmt::print("\nchosen: {}\n", record.formula);
  if (!record.witness.empty()) fmt::print("singular at {}\n", record.witness);
  if (!record.note.empty()) fmt::print("note: {}\n", record.note);
  fmt::print("{} node-rows, {:.3g} CPU seconds\n", record.evaluations, record.fit_cpu_s);
}

void fit(const FitArguments& arguments, const Registry& registry) {
  const AlgorithmEntry& entry = registry.find(arguments.method);
  std::map<std::string, ParameterValue> parameters;
  for (const std::string& text : arguments.parameters) {
    const auto [name, value] = name_and_value(text, "--parameter");
    parameters[name] = parameter_from_text(entry.parameters, name, value);
  }
  const std::unique_ptr<Regressor> method = registry.make(arguments.method, parameters);
  const Dataset train = read_columns(arguments.data, arguments);
  std::optional<Dataset> test;
  if (!arguments.test.empty()) test = read_columns(arguments.test, arguments);
  const Problem problem =
      make_data_problem(train, test ? &*test : nullptr, arguments.target, arguments.inputs);
  const CellResult result =
      fit_and_judge(problem, *method, task_of(arguments, problem, entry.fixed_form));
  if (result.record.status != "ok") {
    const bool is_unsupported = result.record.reason.starts_with("unsupported");
    throw Error(is_unsupported ? ErrorKind::bad_input : ErrorKind::failed, result.record.reason,
                arguments.method,
                is_unsupported
                    ? "say what the columns are (--roles COLUMN=ROLE), or choose another "
                      "method"
                    : "");
  }
  arguments.json ? print_json(result) : print_text(result);
}

}  // namespace

void add_fit_command(CLI::App& app, ExitStatus& /*status*/, const Registry& registry) {
  CLI::App* command = app.add_subcommand("fit", "Fit one method to a data file");
  command->footer(
      "Example: tribench fit joint.csv --target tau_f --inputs v,sgn_v --method pysr --test "
      "later.csv\n"
      "Without --test the errors on test rows stay empty: nothing is held out.");
  auto arguments = std::make_shared<FitArguments>();
  command->add_option("DATA", arguments->data, "the data file (CSV)")->required();
  command->add_option("--target", arguments->target, "the column to explain")->required();
  command
      ->add_option("--inputs", arguments->inputs, "the columns to explain it by; sgn_X is derived")
      ->required()
      ->delimiter(',');
  command->add_option("--method", arguments->method, "a name of `tribench list methods`")
      ->required();
  command->add_option("--operators", arguments->operators, "a name of `tribench list operators`")
      ->capture_default_str();
  command->add_option("--parameter", arguments->parameters, "name=value of the method; repeatable");
  add_data_options(*command, arguments->reading);
  command->add_option("--seed", arguments->seed, "same seed, same result")
      ->transform(whole_number(0))
      ->capture_default_str();
  CLI::Option* evaluations =
      command->add_option("--evaluations", arguments->evaluations, "budget in node-rows")
          ->transform(whole_number(0))
          ->capture_default_str();
  CLI::Option* seconds =
      command
          ->add_option(
              "--seconds", arguments->seconds,
              "CPU seconds to spend: fits again from other starts until they are, or the data "
              "are explained to rounding; without it one fit of at most 60")
          ->transform(real_number(0.0, 1e9));
  command->add_option("--test", arguments->test, "other data to judge by");
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments, &registry, seconds, evaluations] {
    constexpr std::uint64_t kNoLimit = 1'000'000'000'000'000'000;
    arguments->spends_all = seconds->count() > 0;
    if (arguments->spends_all && evaluations->count() == 0) arguments->evaluations = kNoLimit;
    fit(*arguments, registry);
  });
}

}  // namespace tribench
