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
#include <vector>

#include "algorithms/diagnosis/effect_library.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/registry.hpp"
#include "harness/cli/commands.hpp"
#include "harness/shipped_grids.hpp"
#include "problems/catalogue.hpp"
#include "problems/measured/manifest.hpp"

namespace tribench {
namespace {

struct Listed {
  std::string name;
  std::string summary;
};

std::vector<Listed> listed_problems() {
  std::vector<Listed> all;
  const Catalogue catalogue;
  for (const ProblemEntry& entry : catalogue.entries()) all.push_back({entry.name, entry.summary});
  return all;
}

std::vector<Listed> listed_methods(const Registry& registry) {
  std::vector<Listed> all;
  for (const AlgorithmEntry& entry : registry.entries()) all.push_back({entry.name, entry.summary});
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
  for (const measured::Manifest& set : measured::manifests()) all.push_back({set.name, set.title});
  return all;
}

std::vector<Listed> listed_grids() {
  std::vector<Listed> all;
  for (const ShippedGrid& grid : shipped_grids()) all.push_back({grid.name, grid.summary});
  return all;
}

void print_list(const std::vector<Listed>& all, bool json) {
  if (json) {
    nlohmann::json array = nlohmann::json::array();
    for (const Listed& item : all)
      array.push_back({{"name", item.name}, {"summary", item.summary}});
    fmt::print("{}\n", array.dump(2));
    return;
  }
  std::size_t width = 0;
  for (const Listed& item : all) width = std::max(width, item.name.size());
  for (const Listed& item : all) fmt::print("{:<{}}  {}\n", item.name, width, item.summary);
}

void add_kind(CLI::App& list, const char* name, const char* summary,
              std::function<std::vector<Listed>()> items) {
  CLI::App* kind = list.add_subcommand(name, summary);
  auto json = std::make_shared<bool>(false);
  kind->add_flag("--json", *json, "an array of {name, summary}");
  kind->callback([json, items = std::move(items)] { print_list(items(), *json); });
}

}  // namespace

void add_list_command(CLI::App& app, ExitStatus& /*status*/, const Registry& registry) {
  CLI::App* list = app.add_subcommand("list", "What there is");
  list->footer("Example: tribench list problems --json");
  list->require_subcommand(1);
  add_kind(*list, "problems", "Every problem of the catalogue", listed_problems);
  add_kind(*list, "methods", "Every algorithm a grid can name",
           [&registry] { return listed_methods(registry); });
  add_kind(*list, "effects", "What the closed loop can find", listed_effects);
  add_kind(*list, "operators", "The operator sets", listed_operators);
  add_kind(*list, "data", "The measured sets", listed_data);
  add_kind(*list, "grids", "The grids that come with the program", listed_grids);
}

}  // namespace tribench
