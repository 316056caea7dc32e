// SPDX-License-Identifier: MIT
//
// Grids as TOML: what a run's folder keeps.
#include <toml++/toml.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "harness/grid.hpp"
#include "problems/user/user_problem_text.hpp"
#include "reports/published.hpp"

namespace tribench {
namespace {

toml::table parameters_table(const std::map<std::string, ParameterValue>& parameters) {
  toml::table table;
  for (const auto& [name, value] : parameters) {
    std::visit([&table, &key = name](const auto& plain) { table.insert(key, plain); }, value);
  }
  return table;
}

template <typename Items, typename TextOf = std::identity>
toml::array text_array(const Items& items, TextOf text_of = {}) {
  toml::array array;
  for (const auto& item : items) array.push_back(std::invoke(text_of, item));
  return array;
}

void insert_limits(toml::table& table, const CellLimits& limits) {
  table.insert("evaluations", static_cast<std::int64_t>(limits.evaluations));
  table.insert("seconds", limits.seconds);
  table.insert("wall_seconds", limits.wall_seconds);
  table.insert("cpu_limit_seconds", limits.cpu_limit_seconds);
  table.insert("memory_mib", limits.memory_mib);
  if (limits.spend) table.insert("spend", true);
}

toml::table method_table(const Method& method) {
  toml::table table;
  table.insert("name", method.name);
  if (!method.parameters.empty()) {
    table.insert("parameters", parameters_table(method.parameters));
  }
  if (!method.is_external()) {
    table.insert("algorithm", method.algorithm);
    return table;
  }
  table.insert("command", text_array(method.command));
  table.insert("operators", text_array(method.operators));
  table.insert("fixed_form", method.fixed_form);
  if (method.limits) insert_limits(table, *method.limits);
  return table;
}

toml::table operator_set_table(const OperatorSet& set) {
  std::vector<std::string> words;
  for (const Op op : set.operators()) words.emplace_back(op_name(op));
  toml::table table;
  table.insert("name", set.name());
  table.insert("summary", set.summary());
  table.insert("operators", text_array(words));
  table.insert("proved_free_only", set.proved_free_only());
  return table;
}

bool is_built_in(const OperatorSet& set) {
  return std::ranges::any_of(
      operator_sets(), [&](const OperatorSet& built_in) { return built_in.name() == set.name(); });
}

std::string print_grid_with(const Grid& grid, const toml::array& own) {
  toml::table table;
  table.insert("name", grid.name);
  table.insert("problems", text_array(grid.problems));
  table.insert("methods", text_array(grid.methods, &Method::name));
  table.insert("operators", text_array(grid.operators, &OperatorSet::name));
  table.insert("seeds", toml::table{{"first", static_cast<std::int64_t>(grid.first_seed)},
                                    {"count", static_cast<std::int64_t>(grid.seed_count)}});
  // Of a list of another run's cells, or with fewer seeds than the file had, some take no effect.
  table.insert("quarantine", text_array(grid.effective_quarantine()));
  if (!grid.reference.empty()) table.insert("reference", kPublishedFile);
  toml::table budget;
  insert_limits(budget, grid.limits);
  toml::table root{{"grid", table}, {"budget", budget}};
  root.insert("retry", toml::table{{"crashed", grid.retry.crashed},
                                   {"timeout", grid.retry.timeout},
                                   {"cpu_limit", grid.retry.cpu_limit},
                                   {"out_of_memory", grid.retry.out_of_memory},
                                   {"error", grid.retry.error}});
  if (!grid.prior.max_degree.empty()) {
    toml::table degrees;
    for (const auto& [input, degree] : grid.prior.max_degree) degrees.insert(input, degree);
    root.insert("prior", toml::table{{"max_degree", degrees}});
  }
  if (!own.empty()) root.insert("problem", own);
  toml::array methods;
  toml::array externals;
  toml::array sets;
  for (const Method& method : grid.methods) {
    (method.is_external() ? externals : methods).push_back(method_table(method));
  }
  for (const OperatorSet& set : grid.operators) {
    if (!is_built_in(set)) sets.push_back(operator_set_table(set));
  }
  if (!methods.empty()) root.insert("method", methods);
  if (!externals.empty()) root.insert("external", externals);
  if (!sets.empty()) root.insert("operator_set", sets);
  std::ostringstream text;
  text << root << "\n";
  return text.str();
}

}  // namespace

std::string print_grid(const Grid& grid, const std::filesystem::path& folder) {
  return print_grid_with(grid,
                         user::user_problems_array(grid.own, user::FileNames::from_folder, folder));
}

std::string print_grid_identity(const Grid& grid) {
  return print_grid_with(grid, user::user_problems_array(grid.own, user::FileNames::bare));
}

}  // namespace tribench
