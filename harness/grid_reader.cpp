// SPDX-License-Identifier: MIT
//
// Grids from TOML.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "foundation/error.hpp"
#include "foundation/glob.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "foundation/toml_table.hpp"
#include "harness/grid.hpp"
#include "harness/grid_checks.hpp"
#include "harness/sweep.hpp"
#include "problems/user/user_problem_text.hpp"
#include "problems/variant.hpp"
#include "reports/published.hpp"

namespace tribench {
namespace {

constexpr double kMaxSeconds = 30.0 * 24 * 3600;
constexpr std::int64_t kMaxDegree = 16;
constexpr std::uint64_t kMaxSeeds = 1'000'000;

CellLimits read_limits(const TomlTable& table, CellLimits limits) {
  table.read("evaluations", limits.evaluations);
  table.read("seconds", limits.seconds, 0, kMaxSeconds);
  if (table.has("seconds")) set_seconds(limits, limits.seconds);
  table.read("wall_seconds", limits.wall_seconds, 0.01, kMaxSeconds);
  table.read("cpu_limit_seconds", limits.cpu_limit_seconds, 0.01, kMaxSeconds);
  table.read("memory_mib", limits.memory_mib, 16, 1 << 24);
  table.read("spend", limits.spend);
  if (table.has("seconds") && !table.has("evaluations")) spend_seconds_alone(limits);
  return limits;
}

const std::vector<std::string>& limit_keys() {
  static const std::vector<std::string> kKeys = {"evaluations",       "seconds",    "wall_seconds",
                                                 "cpu_limit_seconds", "memory_mib", "spend"};
  return kKeys;
}

RetryPolicy read_retry(const TomlTable& table) {
  RetryPolicy retry;
  table.read("crashed", retry.crashed, 0, 10);
  table.read("timeout", retry.timeout, 0, 10);
  table.read("cpu_limit", retry.cpu_limit, 0, 10);
  table.read("out_of_memory", retry.out_of_memory, 0, 10);
  table.read("error", retry.error, 0, 10);
  return retry;
}

Prior read_prior(const TomlTable& table) {
  Prior prior;
  for (const auto& [input, value] : table.values("max_degree")) {
    const auto* degree = std::get_if<std::int64_t>(&value);
    if (degree == nullptr || *degree < 1 || *degree > kMaxDegree) {
      throw_bad_input(
          fmt::format("the degree of '{}' is no whole number from 1 to {}", input, kMaxDegree),
          table.place("max_degree"), "as in max_degree = { g = 1 }");
    }
    prior.max_degree[input] = static_cast<int>(*degree);
  }
  return prior;
}

std::vector<OperatorSet> known_operator_sets(const TomlTable& file, DeclaredNames& declared) {
  std::vector<OperatorSet> sets = operator_sets();
  for (const TomlTable& table :
       file.array_of_tables("operator_set", {"name", "summary", "operators", "proved_free_only"})) {
    table.require("name");
    table.require("operators");
    std::string name;
    std::string summary;
    std::vector<std::string> words;
    bool proved_free_only = false;
    table.read("name", name);
    require_plain_name(name, "an operator set", table.place("name"));
    if (std::ranges::count(operator_sets(), name, &OperatorSet::name) > 0) {
      throw_bad_input(fmt::format("'{}' is the name of a set that there is", name),
                      table.place("name"), "give yours another name");
    }
    declared.add(name, table.place("name"), table.place());
    table.read("summary", summary);
    table.read("operators", words);
    table.read("proved_free_only", proved_free_only);
    std::vector<std::string> known;
    std::vector<Op> operations;
    for (int i = 0; i < kOpCount; ++i) {
      const Op op = static_cast<Op>(i);
      if (arity(op) == 0 || op == Op::neg) continue;
      operations.push_back(op);
      known.emplace_back(op_name(op));
    }
    std::vector<Op> operators;
    for (const std::string& word : words) {
      const auto found = std::ranges::find(known, word);
      if (found == known.end()) {
        throw_bad_input(fmt::format("there is no operation '{}'", word), table.place("operators"),
                        fmt::format("known: {}", fmt::join(known, " ")));
      }
      operators.push_back(operations[static_cast<std::size_t>(found - known.begin())]);
    }
    sets.emplace_back(name, summary, operators, proved_free_only);
  }
  return sets;
}

std::vector<std::string> pick(const TomlTable& table, std::string_view key,
                              const std::vector<std::string>& known, std::string_view what) {
  std::vector<std::string> globs;
  table.require(key);
  table.read(key, globs);
  return pick_names(globs, known, what, table.place(key));
}

constexpr const char* kRename = "a leaderboard would show one for the other: rename it";

bool is_algorithm(const std::string& name, const Registry& registry) {
  return std::ranges::count(registry.entries(), name, &AlgorithmEntry::name) > 0;
}

Method read_method(const TomlTable& table, const Registry& registry) {
  table.require("name");
  Method method;
  table.read("name", method.name);
  method.algorithm = method.name;
  table.read("algorithm", method.algorithm);
  method.parameters = table.values("parameters");
  const std::string place = table.has("parameters") ? table.place("parameters") : table.place();
  at_place(place, [&] { return registry.make(method.algorithm, method.parameters); });
  method.fixed_form = registry.find(method.algorithm).fixed_form;
  if (method.name != method.algorithm && is_algorithm(method.name, registry)) {
    throw_bad_input(fmt::format("'{}' is the name of another algorithm than '{}'", method.name,
                                method.algorithm),
                    table.place("name"), kRename);
  }
  return method;
}

Method read_external(const TomlTable& table, const Registry& registry,
                     const std::vector<std::string>& set_names, const CellLimits& limits) {
  table.require("name");
  table.require("command");
  Method method;
  table.read("name", method.name);
  if (is_algorithm(method.name, registry)) {
    throw_bad_input(fmt::format("'{}' is the name of an algorithm, not of a program", method.name),
                    table.place("name"), kRename);
  }
  table.read("command", method.command);
  if (method.command.empty()) throw_bad_input("'command' is empty", table.place("command"));
  method.parameters = table.values("parameters");
  table.read("fixed_form", method.fixed_form);
  method.operators = set_names;
  if (table.has("operators"))
    method.operators = pick(table, "operators", set_names, "operator set");
  const CellLimits own = read_limits(table, limits);
  if (own != limits) method.limits = own;
  return method;
}

void add_method(const TomlTable& table, DeclaredNames& declared, const Method& method) {
  require_plain_name(method.name, "a method", table.place("name"));
  declared.add(method.name, table.place("name"), table.place());
}

// The registry's algorithms under their own names, then what the file declares; a [[method]]
// with its algorithm's own name replaces it.
std::vector<Method> known_methods(const TomlTable& file, const Registry& registry,
                                  const std::vector<std::string>& set_names,
                                  const CellLimits& limits, DeclaredNames& declared_names) {
  std::vector<Method> declared;
  for (const TomlTable& table :
       file.array_of_tables("method", {"name", "algorithm", "parameters"})) {
    declared.push_back(read_method(table, registry));
    add_method(table, declared_names, declared.back());
  }
  std::vector<std::string> keys = {"name", "command", "operators", "fixed_form", "parameters"};
  keys.insert(keys.end(), limit_keys().begin(), limit_keys().end());
  for (const TomlTable& table : file.array_of_tables("external", keys)) {
    declared.push_back(read_external(table, registry, set_names, limits));
    add_method(table, declared_names, declared.back());
  }
  std::vector<Method> all;
  for (const AlgorithmEntry& entry : registry.entries()) {
    const bool replaced = std::ranges::any_of(
        declared, [&](const Method& method) { return method.name == entry.name; });
    if (!replaced) all.push_back({entry.name, entry.name, {}, entry.fixed_form, {}, {}, {}});
  }
  all.insert(all.end(), declared.begin(), declared.end());
  return all;
}

template <typename Items, typename NameOf>
std::vector<std::string> names_of(const Items& items, NameOf name_of) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(name_of(item));
  return names;
}

std::string read_suite_name(const TomlTable& file) {
  std::string name;
  file.table("suite", suite::suite_keys()).read("name", name);
  return name;
}

std::vector<std::string> problems_of_suite(const std::string& suite,
                                           const std::vector<std::string>& known) {
  std::vector<std::string> names;
  std::ranges::copy_if(known, std::back_inserter(names),
                       [&](const std::string& name) { return name.starts_with(suite + "/"); });
  return names;
}

// A file that is a suite asks for a run of itself: it must be the suite that everybody, worker
// processes too, knows by its name.
void check_suite(std::string_view toml, const std::string& file_name, const Catalogue& catalogue) {
  const suite::Suite own = suite::read_suite(toml, file_name);
  const auto known = std::ranges::find(catalogue.suites(), own.name, &suite::Suite::name);
  if (known != catalogue.suites().end() && known->identity == own.identity) return;
  throw_bad_input(known == catalogue.suites().end()
                      ? fmt::format("the suite '{}' is not known", own.name)
                      : fmt::format("another suite is called '{}'", own.name),
                  file_name, "put the file into DIR/suites and give --data DIR");
}

// Globs over problems; one with a variant (~noise=0.1) picks that of each problem it picks.
std::vector<std::string> pick_problems(const TomlTable& table,
                                       const std::vector<std::string>& known) {
  std::vector<std::string> globs;
  table.require("problems");
  table.read("problems", globs);
  std::vector<std::string> plain;
  std::vector<std::string> variants;
  for (const std::string& glob : globs) {
    const auto [base, suffix] = split_variant(glob);
    if (suffix.empty()) {
      plain.push_back(base);
      continue;
    }
    at_place(table.place("problems"), [&suffix = suffix] { check_variant(suffix); });
    for (const std::string& name : pick_names({base}, known, "problem", table.place("problems"))) {
      const std::string whole = name + suffix;
      if (std::ranges::count(variants, whole) == 0) variants.push_back(whole);
    }
  }
  std::vector<std::string> picked = pick_names(plain, known, "problem", table.place("problems"));
  picked.insert(picked.end(), variants.begin(), variants.end());
  return picked;
}

// The patterns of one of [grid]'s lists, without what they change in a problem.
std::vector<std::string> patterns_of(const TomlTable& table, std::string_view key) {
  std::vector<std::string> globs;
  table.read(key, globs);
  for (std::string& glob : globs) glob = split_variant(glob).first;
  return globs;
}

// Puts their names before those that are known.
void read_own_problems(const TomlTable& file, const std::string& file_name,
                       std::vector<std::string>& names, DeclaredNames& declared, Grid& grid) {
  if (file.has("suite")) return;  // its [[problem]]s are the suite's
  grid.own = user::read_user_problems(file, std::filesystem::path(file_name).parent_path());
  std::vector<std::string> all;
  for (const user::UserProblem& own : grid.own) {
    if (std::ranges::count(names, own.name) > 0) {
      throw_bad_input(fmt::format("there is another problem '{}'", own.name), own.place,
                      "give yours another name");
    }
    declared.add(own.name, own.place, own.place);
    all.push_back(own.name);
  }
  all.insert(all.end(), names.begin(), names.end());
  names = std::move(all);
}

void read_axes(const TomlTable& file, const TomlTable& table, const Registry& registry,
               const Catalogue& catalogue, const std::string& file_name, Grid& grid) {
  std::vector<std::string> names =
      names_of(catalogue.entries(), [](const ProblemEntry& entry) { return entry.name; });
  if (file.has("suite") && !table.has("problems")) {
    grid.problems = problems_of_suite(read_suite_name(file), names);
  } else {
    DeclaredNames declared("problem", "problems");
    read_own_problems(file, file_name, names, declared, grid);
    // A file that brings problems and names none runs those.
    grid.problems = table.has("problems") || grid.own.empty()
                        ? pick_problems(table, names)
                        : names_of(grid.own, [](const auto& own) { return own.name; });
    if (table.has("problems")) declared.require_named(patterns_of(table, "problems"));
  }
  const Sweep sweep(table, registry);
  grid.problems = sweep.over_problems(grid.problems);
  std::erase_if(grid.own, [&](const user::UserProblem& own) {
    return std::ranges::none_of(grid.problems, [&](const std::string& problem) {
      return split_variant(problem).first == own.name;
    });
  });
  for (const suite::Suite& suite : catalogue.suites()) {
    const std::string prefix = suite.name + "/";
    if (std::ranges::any_of(grid.problems,
                            [&](const std::string& name) { return name.starts_with(prefix); })) {
      grid.suites.push_back(suite);
    }
  }
  DeclaredNames declared_sets("operator set", "operators");
  const std::vector<OperatorSet> sets = known_operator_sets(file, declared_sets);
  const std::vector<std::string> set_names =
      names_of(sets, [](const OperatorSet& set) { return set.name(); });
  const std::vector<std::string> chosen_sets =
      table.has("operators") ? pick(table, "operators", set_names, "operator set")
                             : std::vector<std::string>{"paper"};
  declared_sets.require_named(patterns_of(table, "operators"));
  for (const OperatorSet& set : sets) {
    if (std::ranges::count(chosen_sets, set.name()) > 0) grid.operators.push_back(set);
  }
  DeclaredNames declared_methods("method", "methods");
  const std::vector<Method> known =
      known_methods(file, registry, set_names, grid.limits, declared_methods);
  const std::vector<std::string> chosen =
      pick(table, "methods", names_of(known, [](const Method& method) { return method.name; }),
           "method");
  declared_methods.require_named(patterns_of(table, "methods"));
  sweep.require_methods(chosen);
  for (const Method& method : known) {
    if (std::ranges::count(chosen, method.name) == 0) continue;
    for (Method& one : sweep.over_method(method)) grid.methods.push_back(std::move(one));
  }
}

// A pattern that leaves nothing out is a slip: what should not run would run.
void require_quarantined_cells(const Grid& grid, const std::string& place) {
  const std::vector<std::string> idle = grid.idle_quarantine();
  if (idle.empty()) return;
  throw_bad_input(fmt::format("no cell of the grid is '{}'", idle.front()), place,
                  fmt::format("cells are PROBLEM|METHOD|OPERATORS|SEED, the first here is '{}'; "
                              "--dry-run lists them",
                              grid.series().front().key()));
}

struct ReadGrid {
  Grid grid;
  std::string reference_place;
};

ReadGrid read_grid(std::string_view toml, const std::string& file_name, const Registry& registry,
                   const Catalogue& catalogue) {
  const toml::table root = parse_toml(toml, file_name);
  std::vector<std::string> keys = {"grid",   "budget",   "retry",        "prior",
                                   "method", "external", "operator_set", "problem"};
  if (root.contains("suite")) {
    keys.insert(keys.end(), {"suite", "reference", "published"});
    check_suite(toml, file_name, catalogue);
  }
  const TomlTable file(root, file_name, "", keys);
  file.require("grid");
  const TomlTable table = file.table("grid", {"name", "problems", "methods", "operators", "seeds",
                                              "quarantine", "reference", "sweep"});
  Grid grid;
  grid.name = std::filesystem::path(file_name).stem().string();
  table.read("name", grid.name);
  require_plain_name(grid.name, "a grid", table.place(table.has("name") ? "name" : "problems"));
  const TomlTable seeds = table.table("seeds", {"first", "count"});
  seeds.read("first", grid.first_seed);
  seeds.read("count", grid.seed_count);
  if (grid.seed_count == 0 || grid.seed_count > kMaxSeeds) {
    throw_bad_input(fmt::format("'count' is {}", grid.seed_count), seeds.place("count"),
                    fmt::format("use 1 to {}", kMaxSeeds));
  }
  table.read("quarantine", grid.quarantine);
  table.read("reference", grid.reference_file);
  grid.limits = read_limits(file.table("budget", limit_keys()), grid.limits);
  grid.retry = read_retry(
      file.table("retry", {"crashed", "timeout", "cpu_limit", "out_of_memory", "error"}));
  grid.prior = read_prior(file.table("prior", {"max_degree"}));
  read_axes(file, table, registry, catalogue, file_name, grid);
  grid.require_runnable(table.place());
  require_quarantined_cells(grid, table.place("quarantine"));
  require_readable_laws(grid);
  require_inputs_of_prior(grid, catalogue, file.table("prior", {"max_degree"}).place("max_degree"));
  return {std::move(grid), table.place("reference")};
}

}  // namespace

Grid parse_grid(std::string_view toml, const std::string& file_name, const Registry& registry,
                const Catalogue& catalogue) {
  return read_grid(toml, file_name, registry, catalogue).grid;
}

Grid load_grid(const std::filesystem::path& file, const Registry& registry,
               const Catalogue& catalogue) {
  if (std::error_code unknown; !std::filesystem::exists(file, unknown)) {
    throw_bad_input("the grid file cannot be read", file.string(),
                    "give the path of a TOML file, or a name from: tribench list grids");
  }
  auto [grid, place] = read_grid(read_file(file), file.string(), registry, catalogue);
  if (grid.reference_file.empty()) return grid;
  const std::filesystem::path reference = file.parent_path() / grid.reference_file;
  const auto figures = read_file_if_there(reference);
  if (!figures) {
    throw_bad_input(fmt::format("the published figures '{}' cannot be read", reference.string()),
                    place, "'reference' is a path from the grid file's folder");
  }
  at_place(place, [&] { check_published(*figures, reference.string()); });
  grid.reference = *figures;
  return grid;
}

}  // namespace tribench
