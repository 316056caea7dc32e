// SPDX-License-Identifier: MIT
//
// tribench list: what there is, one name a line, or JSON.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/registry.hpp"
#include "foundation/json_text.hpp"
#include "harness/cli/commands.hpp"
#include "harness/shipped_grids.hpp"
#include "problems/measured/data_folder.hpp"
#include "problems/measured/manifest.hpp"

namespace tribench {
namespace {

struct Listed {
  std::string name;
  std::string summary;
  nlohmann::json more = nlohmann::json::object();  // beside them in JSON
};

nlohmann::json json_of(const ParameterValue& value) {
  return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

// What a method accepts; the text says the default and the choices too.
std::vector<Listed> listed_parameters(const AlgorithmEntry& method) {
  std::vector<Listed> all;
  for (const ParameterSpec& spec : method.parameters) {
    nlohmann::json more = {{"default", json_of(spec.default_value)}};
    const bool is_number = spec.default_value.index() == 1 || spec.default_value.index() == 2;
    if (is_number) more.update({{"low", spec.low}, {"high", spec.high}});
    if (spec.besides) more["besides"] = *spec.besides;
    if (!spec.choices.empty()) more["choices"] = spec.choices;
    all.push_back({spec.name, spec.summary, std::move(more)});
  }
  return all;
}

nlohmann::json array_of(const std::vector<Listed>& all) {
  nlohmann::json array = nlohmann::json::array();
  for (const Listed& item : all) {
    nlohmann::json object = {{"name", item.name}, {"summary", item.summary}};
    object.update(item.more);
    array.push_back(std::move(object));
  }
  return array;
}

std::vector<Listed> listed_methods(const Registry& registry) {
  std::vector<Listed> all;
  for (const AlgorithmEntry& entry : registry.entries()) {
    all.push_back(
        {entry.name, entry.summary, {{"parameters", array_of(listed_parameters(entry))}}});
  }
  return all;
}

std::vector<Listed> listed_effects() {
  std::vector<Listed> all;
  for (const loop::EffectFamily& family : loop::builtin_effects()) {
    all.push_back({family.name, family.summary});
  }
  return all;
}

std::vector<Listed> listed_operators() {
  std::vector<Listed> all;
  for (const OperatorSet& set : operator_sets()) all.push_back({set.name(), set.summary()});
  return all;
}

std::vector<Listed> listed_data() {
  std::vector<Listed> all;
  for (const auto& set : measured::known_manifests(measured::find_data_folder({}))) {
    all.push_back({set.name, set.title});
  }
  return all;
}

std::vector<Listed> listed_grids() {
  std::vector<Listed> all;
  for (const ShippedGrid& grid : shipped_grids()) all.push_back({grid.name, grid.summary});
  return all;
}

void print_list(const std::vector<Listed>& all, bool json) {
  if (json) {
    fmt::print("{}\n", write_json(array_of(all), 2));
    return;
  }
  std::size_t width = 0;
  for (const Listed& item : all) width = std::max(width, item.name.size());
  for (const Listed& item : all) {
    fmt::print("{:<{}}  {}", item.name, width, item.summary);
    if (item.more.contains("high")) {
      fmt::print("; {} to {}", write_json(item.more["low"]), write_json(item.more["high"]));
    }
    if (item.more.contains("choices")) fmt::print("; one of {}", write_json(item.more["choices"]));
    if (item.more.contains("default")) fmt::print(" [{}]", write_json(item.more["default"]));
    fmt::print("\n");
  }
}

void add_kind(CLI::App& list, const char* name, const char* summary,
              std::function<std::vector<Listed>()> items) {
  CLI::App* kind = list.add_subcommand(name, summary);
  auto json = std::make_shared<bool>(false);
  kind->add_flag("--json", *json, "an array of {name, summary}");
  kind->callback([json, items = std::move(items)] { print_list(items(), *json); });
}

void add_methods(CLI::App& list, const Registry& registry) {
  CLI::App* kind = list.add_subcommand(
      "methods", "Every algorithm a grid can name; with a name, its parameters");
  auto name = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  kind->add_option("name", *name, "the method whose parameters are listed");
  kind->add_flag("--json", *json, "an array of {name, summary}; of methods, with parameters");
  kind->callback([name, json, &registry] {
    print_list(name->empty() ? listed_methods(registry) : listed_parameters(registry.find(*name)),
               *json);
  });
}

}  // namespace

void add_list_command(CLI::App& app, ExitStatus& /*status*/, const Registry& registry) {
  CLI::App* list = app.add_subcommand("list", "What there is");
  list->footer("Example: tribench list problems fastsrb/I.12.1");
  list->require_subcommand(1);
  add_problem_listing(*list);
  add_methods(*list, registry);
  add_kind(*list, "effects", "What the closed loop can find", listed_effects);
  add_kind(*list, "operators", "The operator sets", listed_operators);
  add_kind(*list, "data", "The measured sets", listed_data);
  add_kind(*list, "grids", "The grids that come with the program", listed_grids);
}

}  // namespace tribench
