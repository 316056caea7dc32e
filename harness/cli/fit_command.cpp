// SPDX-License-Identifier: MIT
//
// tribench fit: one method on the user's own data.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/external/external_method.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/shell_word.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_options.hpp"
#include "harness/cli/fit_output.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/decades_fit.hpp"
#include "harness/machine.hpp"
#include "harness/run_cell.hpp"
#include "harness/state_refit.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"
#include "harness/weighted_fit.hpp"
#include "problems/data_problem.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench {
namespace {

struct FitArguments {
  std::string data;
  std::string target;
  std::vector<std::string> inputs;
  std::string method;
  std::string external;
  std::string weights;
  std::string sigma;
  std::string category;
  std::string group;
  std::optional<user::HeldOut> held_out;
  std::string save;
  std::vector<std::string> words;  // of the command line, after the program's name
  std::string operators = "paper";
  std::vector<std::string> parameters;  // name=value
  std::vector<std::string> states;      // declarations
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> evaluations;
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

std::vector<std::string> used_columns(const FitArguments& arguments) {
  std::vector<std::string> used = arguments.inputs;
  for (const std::string* more :
       {&arguments.target, &arguments.weights, &arguments.sigma, &arguments.category}) {
    if (!more->empty()) used.push_back(*more);
  }
  return used;
}

// But for evaluations, which depend on the rows.
CellLimits limits_of(const FitArguments& arguments) {
  CellLimits limits;
  set_seconds(limits, arguments.seconds);
  limits.spend = arguments.spends_all;
  return limits;
}

// Told neither evaluations nor seconds: a second's worth for a file of few rows, and as many
// evaluations of formulas for one of more, up to what 60 s mostly allow.
std::uint64_t evaluations_of(const FitArguments& arguments, std::size_t rows) {
  if (arguments.evaluations) return *arguments.evaluations;
  if (arguments.spends_all) return CellLimits::kAmple;
  constexpr std::uint64_t kNodeRows = 2'000'000'000;
  constexpr std::size_t kFewRows = 10'000;
  constexpr std::size_t kMostTimes = 20;
  return kNodeRows * std::clamp<std::size_t>(rows / kFewRows, 1, kMostTimes);
}

CellTask task_of(const FitArguments& arguments, const Problem& problem, bool fixed_form) {
  CellTask task;
  const std::string& method = arguments.method.empty() ? arguments.external : arguments.method;
  if (!arguments.external.empty())
    task.method.command = words_of_command(arguments.external, "--external");
  task.cell = {problem.name, method, fixed_form ? kFixedForm : arguments.operators, arguments.seed};
  task.operators = find_operator_set(arguments.operators);
  if (fixed_form) task.operators = fixed_form_operators();
  task.limits = limits_of(arguments);
  task.limits.evaluations = evaluations_of(arguments, problem.stages.front().train.rows());
  task.threads = usable_processors();
  task.stop = &stop_requested_by_signal();
  return task;
}

// A program does not declare the kinds of its parameters: as a grid's TOML would have them.
ParameterValue plain_value(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  if (const auto whole = read_number<std::int64_t>(text)) return *whole;
  if (const auto real = read_number<double>(text)) return *real;
  return text;
}

struct ChosenMethod {
  std::unique_ptr<Regressor> method;
  bool fixed_form = false;
  WidenedMethod widened = {};  // for the rounds after the first
};

ChosenMethod choose_method(const FitArguments& arguments, const Registry& registry) {
  std::map<std::string, ParameterValue> parameters;
  if (!arguments.external.empty()) {
    for (const std::string& text : arguments.parameters) {
      const auto [name, value] = name_and_value(text, "--parameter");
      parameters[name] = plain_value(value);
    }
    // As in a grid's worker; here nobody else watches it.
    const CellLimits limits = limits_of(arguments);
    return {make_external_method(words_of_command(arguments.external, "--external"), parameters,
                                 {limits.cpu_limit_seconds, limits.wall_seconds}),
            false};
  }
  const AlgorithmEntry& entry = registry.find(arguments.method);
  for (const std::string& text : arguments.parameters) {
    const auto [name, value] = name_and_value(text, "--parameter");
    parameters[name] =
        at_place(fmt::format("method '{}'", entry.name), [&, &key = name, &given = value] {
          return parameter_from_text(entry.parameters, key, given);
        });
  }
  WidenedMethod widened;
  if (entry.widened != nullptr) {
    widened = [&registry, name = arguments.method, parameters](int round) {
      return registry.make(name, parameters, round);
    };
  }
  return {registry.make(arguments.method, parameters), entry.fixed_form, std::move(widened)};
}

// A problem's name is part of the seed: the same rows in a file of another name are the same
// question.
constexpr const char* kProblemName = "data";

// Nothing is held out unless it is asked for; then, as in a grid, by groups or single rows.
Problem make_problem(const FitArguments& arguments, const std::vector<std::string>& inputs) {
  if (!arguments.held_out && arguments.group.empty()) {
    const Dataset train = read_columns(arguments.data, *arguments.reading, used_columns(arguments));
    std::optional<Dataset> test;
    if (!arguments.test.empty()) {
      user::require_apart(std::vector<std::filesystem::path>{arguments.data}, arguments.test,
                          "--test");
      test = read_columns(arguments.test, *arguments.reading, used_columns(arguments));
    }
    Problem problem = make_data_problem(train, test ? &*test : nullptr, arguments.target, inputs);
    problem.name = kProblemName;
    return problem;
  }
  user::UserProblem own;
  own.name = kProblemName;
  const std::vector<std::filesystem::path> files = {arguments.data};
  own.files = user::hashed(files);
  own.target = arguments.target;
  own.inputs = inputs;
  own.reading = *arguments.reading;
  own.group = arguments.group;
  own.held_out.kind = user::HeldOut::Kind::nothing;
  if (arguments.held_out) own.held_out = *arguments.held_out;
  if (!arguments.test.empty()) {
    const std::vector<std::filesystem::path> tests = {arguments.test};
    own.held_out.kind = user::HeldOut::Kind::files;
    own.held_out.files = user::hashed(tests);
  }
  return user::make_user_problem(own, {}, arguments.seed);
}

// Rows that train may be some of the file's, in another order: it is asked for the line.
[[noreturn]] void refuse_weight(const FitArguments& arguments, const ColumnRule& rule,
                                double value) {
  require_rule(arguments.data, *arguments.reading, rule);
  throw_bad_input(fmt::format("'{}' is {} in a row", rule.column, value), arguments.data,
                  rule.words);
}

std::vector<double> take_weights(const FitArguments& arguments, Problem& problem) {
  if (arguments.weights.empty() && arguments.sigma.empty()) return {};
  std::vector<double> values = take_last_input(problem).train;
  const bool is_sigma = !arguments.sigma.empty();
  const ColumnRule rule =
      is_sigma ? ColumnRule{arguments.sigma, [](double value) { return value > 0; },
                            "a standard deviation is above 0"}
               : ColumnRule{arguments.weights, [](double value) { return value >= 0; },
                            "weights are 0 or more; of --sigma, which is above 0, they are "
                            "1/sigma^2"};
  const auto wrong = std::ranges::find_if_not(values, rule.holds);
  if (wrong != values.end()) refuse_weight(arguments, rule, *wrong);
  if (!is_sigma && std::ranges::none_of(values, [](double value) { return value > 0; })) {
    throw_bad_input(fmt::format("'{}' is 0 in all rows", rule.column), arguments.data,
                    "give some rows a weight");
  }
  if (!is_sigma) return values;
  for (double& value : values) value = 1 / (value * value);
  return values;
}

// What gives the same formula again: the same command, where the clock had no say in it. Seconds
// depend on the machine, evaluations do not; but parts of a search that had their share of the
// seconds have another share of these.
std::string reproducing(const FitArguments& arguments, const Record& record, bool by_clock) {
  std::vector<std::string> words = arguments.words;
  // A program need not say what it has spent: with no evaluations it would be asked for nothing.
  if (by_clock && record.evaluations > 0) {
    constexpr const char* kAmple = "1e6";
    for (const std::string option : {"--seconds", "--evaluations"}) {
      std::erase_if(words, [&](const std::string& word) { return word.starts_with(option + "="); });
      const auto found = std::ranges::find(words, option);
      if (found != words.end()) words.erase(found, std::min(found + 2, words.end()));
    }
    words.insert(words.end(), {"--evaluations", std::to_string(record.evaluations)});
    if (arguments.spends_all) words.insert(words.end(), {"--seconds", kAmple});
  }
  std::string line = "tribench";
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

void add_intervals(const FitArguments& arguments, const Problem& problem,
                   std::span<const double> weights, FitAnswer& answer) {
  const ProblemFormula own = read_problem_formula(answer.result.record.formula, problem);
  const Table& table = own.over(problem).stages.front().train;
  try {
    answer.intervals = fit_intervals(own.formula, TableInputs(table).inputs(), table.target,
                                     table.movement, weights, !arguments.sigma.empty());
  } catch (const Error& error) {
    answer.no_intervals = error.what();
  }
}

// Declared states are inputs of the search; what it finds is fitted once more together with them.
// `weights`: those that were told; where none were, those that the rows ask for.
CellResult run_method(const FitArguments& arguments, const Problem& problem,
                      std::vector<double>& weights, const ChosenMethod& chosen,
                      const CellTask& task) {
  const bool has_states = !arguments.states.empty();
  const Problem declared = has_states ? with_declared_states(problem, arguments.states) : Problem();
  const Problem& seen = has_states ? declared : problem;
  if (!weights.empty()) return fit_weighted(seen, weights, *chosen.method, task, chosen.widened);
  const bool searches = !has_states && !chosen.fixed_form && !task.method.is_external();
  if (searches && task.operators.allows(Op::exp) &&
      lies_over_decades(problem.stages.front().train.target)) {
    return fit_over_decades(problem, *chosen.method, task, chosen.widened, weights);
  }
  CellResult result = fit_and_judge(seen, *chosen.method, task, chosen.widened);
  if (!is_ok(result.record)) return result;
  if (has_states) refit_states(problem, result);
  if (searches) weights = choose_by_relative_noise(problem, task, result);
  return result;
}

void fit_shared_shape(const FitArguments& arguments, Problem& problem, const ChosenMethod& chosen) {
  const CategoryColumn categories = take_last_input(problem);
  const CategoryFit shared =
      fit_by_category(problem, categories, *chosen.method,
                      task_of(arguments, problem, chosen.fixed_form), chosen.widened);
  if (shared.failure.kind != FailureKind::none) {
    const bool is_unsupported = shared.failure.kind == FailureKind::unsupported;
    throw Error(is_unsupported ? ErrorKind::bad_input : ErrorKind::failed,
                reason_text(shared.failure), arguments.method, "");
  }
  if (arguments.json) {
    fmt::print("{}\n", write_json(category_json(shared), 2));
  } else {
    print_category_fit(shared);
  }
}

// What a fit found before it was told to stop is its answer; but not what it was asked for.
ExitStatus status_of_end() {
  return stop_requested_by_signal() ? ExitStatus::undecided : ExitStatus::done;
}

// A column has one place in a fit.
void require_own_columns(const FitArguments& arguments) {
  const auto require = [&](const char* option, const std::string& column, const char* mend) {
    if (column.empty()) return;
    const bool is_input = std::ranges::count(arguments.inputs, column) > 0;
    if (!is_input && column != arguments.target) return;
    throw_bad_input(
        fmt::format("'{}' is {} too", column, is_input ? "one of the --inputs" : "the --target"),
        option, mend);
  };
  constexpr const char* kCopy = "give the column a second time in the file, under another name";
  require("--weights", arguments.weights, kCopy);
  require("--sigma", arguments.sigma, kCopy);
  require("--category", arguments.category, "name it once: each category has constants of its own");
}

void name_inputs(FitArguments& arguments) {
  if (!arguments.inputs.empty()) return;
  arguments.inputs =
      every_other_column(arguments.data, *arguments.reading, arguments.target,
                         {arguments.weights, arguments.sigma, arguments.category, arguments.group,
                          arguments.held_out ? arguments.held_out->column : ""});
}

ExitStatus fit(FitArguments arguments, const Registry& registry) {
  name_inputs(arguments);
  require_own_columns(arguments);
  if (!arguments.save.empty()) try_output_file(arguments.save);
  const ChosenMethod chosen = choose_method(arguments, registry);
  std::vector<std::string> inputs = arguments.inputs;
  for (const std::string* column : {&arguments.weights, &arguments.sigma, &arguments.category}) {
    if (!column->empty()) inputs.push_back(*column);
  }
  Problem problem = make_problem(arguments, inputs);
  if (!arguments.category.empty()) {
    fit_shared_shape(arguments, problem, chosen);
    return status_of_end();
  }
  std::vector<double> weights = take_weights(arguments, problem);
  const CellTask task = task_of(arguments, problem, chosen.fixed_form);
  FitAnswer answer;
  answer.result = run_method(arguments, problem, weights, chosen, task);
  const Record& record = answer.result.record;
  if (!is_ok(record)) {
    const bool is_unsupported = record.reason.kind == FailureKind::unsupported;
    throw Error(is_unsupported ? ErrorKind::bad_input : ErrorKind::failed,
                reason_text(record.reason), arguments.method,
                is_unsupported ? "do as it says, or choose another method" : "");
  }
  const bool by_clock = was_ended_by_clock(record);
  // A search stops before the step that would overdraw its budget.
  constexpr double kSpent = 0.99;
  const bool by_evaluations = static_cast<double>(record.evaluations) >=
                              kSpent * static_cast<double>(task.limits.evaluations);
  answer.ended = stop_requested_by_signal() ? "stopped"
                 : by_clock                 ? "seconds"
                 : by_evaluations           ? "evaluations"
                                            : "finished";
  answer.reproduce = reproducing(arguments, record, by_clock);
  answer.reproduces_exactly = !by_clock;
  answer.inputs = problem.input_names();
  answer.target = problem.target;
  if (!chosen.fixed_form) answer.operators = arguments.operators;
  answer.reading = *arguments.reading;
  add_intervals(arguments, problem, weights, answer);
  if (!arguments.save.empty()) write_file(arguments.save, write_json(fit_json(answer), 2) + "\n");
  if (arguments.json) {
    fmt::print("{}\n", write_json(fit_json(answer), 2));
  } else {
    print_fit(answer);
  }
  return status_of_end();
}

// As they were typed.
std::vector<std::string> own_words() {
  std::string text = read_file_if_there("/proc/self/cmdline").value_or("");
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\0', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (!words.empty()) words.erase(words.begin());
  return words;
}

// What is explained by what, and by which method.
void add_method_options(CLI::App& command, FitArguments& arguments) {
  command.add_option("DATA", arguments.data, "the data file (CSV)")->required();
  command.add_option("--target", arguments.target, "the column to explain")->required();
  command
      .add_option("--inputs", arguments.inputs,
                  "the columns to explain it by; sgn_X is derived; default: every other column of "
                  "numbers")
      ->delimiter(',');
  CLI::Option* method = command.add_option("--method", arguments.method,
                                           "a name of `tribench list methods`; default: relay");
  command
      .add_option("--external", arguments.external,
                  "'PROGRAM WORDS': a program as the method (docs/external_methods.md)")
      ->excludes(method);
  command.add_option("--operators", arguments.operators, "a name of `tribench list operators`")
      ->capture_default_str();
  command.add_option("--parameter", arguments.parameters, "name=value of the method; repeatable");
}

// What it may spend; the option of seconds.
const CLI::Option* add_budget_options(CLI::App& command, FitArguments& arguments) {
  command.add_option("--seed", arguments.seed, "same seed, same result")
      ->transform(whole_number(0))
      ->capture_default_str();
  command
      .add_option("--evaluations", arguments.evaluations,
                  "budget in node-rows; where neither it nor seconds are told 2e9, and of more "
                  "than 20000 rows 2e5 a row, at most 4e10")
      ->transform(whole_number(1));
  return command
      .add_option("--seconds", arguments.seconds,
                  "CPU seconds to spend: fits again from other starts until they are, or the data "
                  "are explained to rounding, and on at most 400 rows looks how complex a formula "
                  "they bear; without it one fit of at most 60")
      ->transform(real_number(0.0, 1e9));
}

// By what it is judged, and how much each row counts.
void add_judging_options(CLI::App& command, FitArguments& arguments) {
  CLI::Option* test = command.add_option("--test", arguments.test, "other data to judge by");
  command
      .add_option_function<std::string>(
          "--split",
          [arguments = &arguments](const std::string& text) {
            arguments->held_out = user::parse_held_out(text, "--split");
          },
          "hold out a share of the rows (0.25), drawn with the seed, or COLUMN=VALUE")
      ->excludes(test);
  command.add_option("--group", arguments.group,
                     "the column whose equal values are one movement: kept whole by --split, the "
                     "unit of the intervals where there are eight");
  CLI::Option* weights = command.add_option("--weights", arguments.weights,
                                            "a column: how much each row's squared error counts");
  CLI::Option* sigma = command.add_option("--sigma", arguments.sigma,
                                          "a column: the standard deviation of each row's target; "
                                          "else one for all rows, or in proportion with the "
                                          "target where the rows say so");
  sigma->excludes(weights);
  command
      .add_option("--category", arguments.category,
                  "a column of numbers (a joint's, a machine's): one shape for all, with constants "
                  "of each one's own, beside each one's own formula")
      ->excludes(weights)
      ->excludes(sigma);
}

}  // namespace

void add_fit_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command = app.add_subcommand("fit", "Fit one method to a data file");
  command->footer(
      "Example: tribench fit joint.csv --target tau_f --inputs v,sgn_v --method pysr --test "
      "later.csv\n"
      "Without --test the errors on test rows stay empty: nothing is held out.\n"
      "Ctrl-C ends the search, and what it has found by then is the answer (exit status 4).");
  auto arguments = std::make_shared<FitArguments>();
  add_method_options(*command, *arguments);
  add_data_options(*command, arguments->reading);
  CLI::Option* states = command->add_option(
      "--state", arguments->states,
      "a state as an input, as in 'z = dahl(v, sliding=1e-4)': its parameters are "
      "fitted with what is found; needs a column with role time; repeatable");
  const CLI::Option* seconds = add_budget_options(*command, *arguments);
  add_judging_options(*command, *arguments);
  CLI::Option* save = command->add_option("--save", arguments->save,
                                          "a file for `tribench predict`, with intervals");
  command->get_option("--category")->excludes(states)->excludes(save);
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments, &registry, &status, seconds] {
    if (arguments->external.empty() && arguments->method.empty()) arguments->method = "relay";
    arguments->words = own_words();
    arguments->spends_all = seconds->count() > 0;
    status = fit(*arguments, registry);
  });
}

}  // namespace tribench
