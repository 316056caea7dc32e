// SPDX-License-Identifier: MIT
//
// tribench list problems: the catalogue, or one problem in full.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "foundation/glob.hpp"
#include "foundation/json_text.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "problems/measured/data_folder.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

struct ListingArguments {
  std::string name;
  std::string data;
  std::uint64_t seed = 1;
  bool json = false;
};

std::size_t movements_of(const Table& table) {
  return std::set<int>(table.movement.begin(), table.movement.end()).size();
}

Json column_json(const std::string& name, const std::string& unit, std::string_view role,
                 double low, double high) {
  return {{"name", name}, {"unit", unit}, {"role", role}, {"low", low}, {"high", high}};
}

Json target_json(const Problem& problem) {
  const std::vector<double>& train = problem.stages.front().train.target;
  double low = train.empty() ? 0 : train.front();
  double high = low;
  for (const std::vector<double>* values : {&train, &problem.test.target}) {
    for (const double value : *values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return column_json(problem.target, problem.target_unit, role_name(Role::none), low, high);
}

// As it is with this seed, which draws its rows or what of them tests.
Json problem_json(const ProblemEntry& entry, std::uint64_t seed) {
  const Problem problem = entry.make(seed);
  Json stages = Json::array();
  for (const Stage& stage : problem.stages) {
    Json inputs = Json::array();
    for (const std::size_t place : stage.inputs) inputs.push_back(problem.inputs[place].name);
    stages.push_back({{"name", stage.name},
                      {"inputs", inputs},
                      {"rows", stage.train.rows()},
                      {"movements", movements_of(stage.train)},
                      {"law", stage.law}});
  }
  Json inputs = Json::array();
  for (const Input& input : problem.inputs) {
    inputs.push_back(
        column_json(input.name, input.unit, role_name(input.role), input.low, input.high));
  }
  return {{"name", entry.name},
          {"summary", entry.summary},
          {"dataset", problem.dataset},
          {"source", entry.source.empty() ? "made by this program" : entry.source},
          {"seed", seed},
          {"target", target_json(problem)},
          {"inputs", inputs},
          {"stages", stages},
          {"test", {{"rows", problem.test.rows()}, {"movements", movements_of(problem.test)}}},
          {"law", problem.true_law()}};
}

void print_column(const char* what, const Json& column) {
  const std::string role = column["role"];
  fmt::print("  {:<7} {} [{}]{}, {:.6g} to {:.6g}\n", what, column["name"].get<std::string>(),
             column["unit"].get<std::string>(), role == "none" ? "" : " (" + role + ")",
             column["low"].get<double>(), column["high"].get<double>());
}

void print_problem(const Json& problem) {
  fmt::print("{}: {}\n", problem["name"].get<std::string>(), problem["summary"].get<std::string>());
  fmt::print("  from    {}\n", problem["source"].get<std::string>());
  print_column("target", problem["target"]);
  for (const Json& input : problem["inputs"]) print_column("input", input);
  for (const Json& stage : problem["stages"]) {
    fmt::print("  {:<7} {} rows, {} movements\n", stage["name"].get<std::string>(),
               stage["rows"].get<std::size_t>(), stage["movements"].get<std::size_t>());
  }
  fmt::print("  test    {} rows, {} movements\n", problem["test"]["rows"].get<std::size_t>(),
             problem["test"]["movements"].get<std::size_t>());
  const std::string law = problem["law"];
  fmt::print("  law     {}\n", law.empty() ? "not known" : law);
}

void list_names(const Catalogue& catalogue, const ListingArguments& arguments) {
  std::vector<const ProblemEntry*> shown;
  std::size_t width = 0;
  for (const ProblemEntry& entry : catalogue.entries()) {
    if (!arguments.name.empty() && !glob_matches(arguments.name, entry.name)) continue;
    shown.push_back(&entry);
    width = std::max(width, entry.name.size());
  }
  if (shown.empty()) catalogue.find(arguments.name);  // throws with the nearest name
  if (!arguments.json) {
    for (const ProblemEntry* entry : shown) {
      fmt::print("{:<{}}  {}\n", entry->name, width, entry->summary);
    }
    return;
  }
  Json array = Json::array();
  for (const ProblemEntry* entry : shown) {
    array.push_back({{"name", entry->name}, {"summary", entry->summary}});
  }
  fmt::print("{}\n", write_json(array, 2));
}

void list_problems(const ListingArguments& arguments) {
  const auto data = measured::find_data_folder(
      arguments.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(arguments.data));
  const Catalogue catalogue = full_catalogue(data);
  const bool one =
      !arguments.name.empty() && arguments.name.find_first_of("*?") == std::string::npos;
  if (!one) {
    list_names(catalogue, arguments);
    return;
  }
  const Json problem = problem_json(catalogue.find(arguments.name), arguments.seed);
  if (arguments.json) {
    fmt::print("{}\n", write_json(Json::array({problem}), 2));
  } else {
    print_problem(problem);
  }
}

}  // namespace

void add_problem_listing(CLI::App& list) {
  CLI::App* kind = list.add_subcommand(
      "problems", "Every problem of the catalogue; with a name, its rows, columns and source");
  auto arguments = std::make_shared<ListingArguments>();
  kind->add_option("name", arguments->name, "one problem in full, or a glob of those to list");
  kind->add_option("--data", arguments->data, "folder of the measured sets");
  kind->add_option("--seed", arguments->seed, "with a name: as it is with this seed")
      ->transform(whole_number(0))
      ->capture_default_str();
  kind->add_flag("--json", arguments->json, "an array of {name, summary, ...}");
  kind->callback([arguments] { list_problems(*arguments); });
}

}  // namespace tribench
