// SPDX-License-Identifier: MIT
#include "problems/suite/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/random.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/toml_table.hpp"

namespace tribench::suite {
namespace {

// Of a range's ends, so that its width is a number too.
constexpr double kLargest = 0.25 * std::numeric_limits<double>::max();
constexpr int kMostRows = 1'000'000;
constexpr std::array<const char*, 4> kTestKeys = {"test_draw", "test_low", "test_high",
                                                  "test_step"};
constexpr double kMostWhole = 0x1p53;  // up to here every whole number is a double

template <typename Value>
Value choose(const TomlTable& table, const char* key,
             const std::vector<std::pair<std::string, Value>>& choices, Value otherwise) {
  if (!table.has(key)) return otherwise;
  std::string word;
  table.read(key, word);
  std::vector<std::string> words;
  for (const auto& [name, value] : choices) {
    if (name == word) return value;
    words.push_back(name);
  }
  throw_bad_input(fmt::format("'{}' is no {}", word, key), table.place(key),
                  did_you_mean(word, words));
}

void read_range(const TomlTable& table, const char* low, const char* high, const char* step,
                Draw& draw) {
  table.read(low, draw.low, -kLargest, kLargest);
  table.read(high, draw.high, -kLargest, kLargest);
  table.read(step, draw.step, 0, kLargest);
}

bool is_whole(double x) { return std::floor(x) == x && std::abs(x) <= kMostWhole; }

void check_draw(const TomlTable& table, const Draw& draw) {
  if (!(draw.low < draw.high)) {
    throw_bad_input(fmt::format("'low' is {} and 'high' {}", draw.low, draw.high), table.place(),
                    "low must be less than high");
  }
  if (draw.kind == Draw::Kind::whole && !(is_whole(draw.low) && is_whole(draw.high))) {
    throw_bad_input(
        fmt::format("'low' is {} and 'high' {} with draw = \"whole\"", draw.low, draw.high),
        table.place(), fmt::format("give whole numbers up to {:g}", kMostWhole));
  }
  if (draw.kind == Draw::Kind::log && draw.low <= 0) {
    throw_bad_input(fmt::format("'low' is {} with draw = \"log\"", draw.low), table.place(),
                    "low must be greater than 0; sign = \"either\" or \"negative\" turns the sign");
  }
  if (draw.kind == Draw::Kind::lattice && !(draw.step > 0)) {
    throw_bad_input("a lattice needs a 'step'", table.place());
  }
  if (draw.kind == Draw::Kind::lattice && draw.sign != Draw::Sign::as_drawn) {
    throw_bad_input("a lattice has no 'sign'", table.place(), "give it a negative 'low'");
  }
}

bool has_lattice(const SuiteProblem& problem, Draw SuiteInput::*draw) {
  return std::ranges::any_of(problem.inputs, [draw](const SuiteInput& input) {
    return (input.*draw).kind == Draw::Kind::lattice;
  });
}

bool draws_rows(const SuiteProblem& problem, Draw SuiteInput::*draw) {
  return problem.file.empty() && !has_lattice(problem, draw);
}

// The rows that the lattices of the inputs make together.
void check_lattice(const TomlTable& table, const SuiteProblem& problem, Draw SuiteInput::*draw) {
  double rows = 1;
  for (const SuiteInput& input : problem.inputs) rows *= lattice_points(input.*draw);
  if (rows > kMostRows) {
    throw_bad_input(
        fmt::format("the lattices of problem '{}' have {:.3g} points", problem.name, rows),
        table.place(), fmt::format("{} at most: give larger steps", kMostRows));
  }
}

// A number of rows that nothing takes would be read as one that is kept.
void check_rows(const TomlTable& table, const SuiteProblem& problem, const char* key,
                std::size_t rows, Draw SuiteInput::*draw) {
  const bool counts = draws_rows(problem, draw);
  if (counts && rows == 0) {
    throw_bad_input(fmt::format("nothing says how many rows of '{}' to draw", problem.name),
                    table.place(), fmt::format("give '{}', here or in [suite]", key));
  }
  if (counts || !table.has(key)) return;
  const bool is_test = draw == &SuiteInput::test;
  throw_bad_input(
      fmt::format("'{}' is {} and a {} has as many rows as it has", key, rows,
                  problem.file.empty() ? "lattice" : "table"),
      table.place(key),
      is_test && problem.file.empty()
          ? "leave it out; or leave out all that is said of the inputs' test points, and so many "
            "are drawn"
          : "leave it out");
}

// Of a number in [suite], which is for all problems that draw.
void check_default_rows(const TomlTable& head, const Suite& suite, const char* key,
                        Draw SuiteInput::*draw) {
  const bool counts = std::ranges::any_of(
      suite.problems, [draw](const SuiteProblem& one) { return draws_rows(one, draw); });
  if (counts || suite.problems.empty() || !head.has(key)) return;
  throw_bad_input(fmt::format("'{}' is given and no problem of the suite draws {}", key,
                              draw == &SuiteInput::test ? "test rows" : "rows"),
                  head.place(key),
                  "leave it out: lattices and tables have as many rows as they have");
}

// Where nothing is said of the unseen rows, those of a lattice lie between its points: on them they
// would have been seen.
void set_lattice_tests(const TomlTable& table, SuiteProblem& problem, bool says_test) {
  const bool is_same =
      has_lattice(problem, &SuiteInput::train) &&
      std::ranges::all_of(problem.inputs, [](const SuiteInput& input) {
        return input.test == input.train && input.train.kind == Draw::Kind::lattice;
      });
  if (says_test && is_same) {
    throw_bad_input(
        fmt::format("the test points of problem '{}' are its training points", problem.name),
        table.place("inputs"),
        "give another test_step, or leave test_low, test_high, test_step and test_draw out: then "
        "'test_rows' points are drawn");
  }
  if (says_test) return;
  for (SuiteInput& input : problem.inputs) {
    if (input.test.kind == Draw::Kind::lattice) input.test.kind = Draw::Kind::uniform;
  }
}

// A step that no lattice takes.
void check_steps(const TomlTable& table, const SuiteInput& input) {
  const bool trains = input.train.kind == Draw::Kind::lattice;
  const bool tests = input.test.kind == Draw::Kind::lattice;
  for (const char* key : {"step", "test_step"}) {
    const bool counts = std::string_view(key) == "step" ? trains || tests : tests;
    if (counts || !table.has(key)) continue;
    throw_bad_input(fmt::format("'{}' of input '{}' is of no lattice", key, input.name),
                    table.place(key), "leave it out, or give draw = \"lattice\"");
  }
}

bool says_test_points(const TomlTable& input) {
  return std::ranges::any_of(kTestKeys, [&](const char* key) { return input.has(key); });
}

SuiteInput read_input(const TomlTable& table) {
  for (const char* key : {"name", "low", "high"}) table.require(key);
  SuiteInput input;
  table.read("name", input.name);
  require_formula_name(input.name, table.place("name"));
  table.read("unit", input.unit);
  table.read("meaning", input.meaning);
  using enum Draw::Kind;
  const std::vector<std::pair<std::string, Draw::Kind>> kinds = {
      {"uniform", uniform}, {"log", log}, {"whole", whole}, {"lattice", lattice}};
  input.train.kind = choose(table, "draw", kinds, uniform);
  input.train.sign = choose<Draw::Sign>(table, "sign",
                                        {{"as_drawn", Draw::Sign::as_drawn},
                                         {"either", Draw::Sign::either},
                                         {"negative", Draw::Sign::negative}},
                                        Draw::Sign::as_drawn);
  read_range(table, "low", "high", "step", input.train);
  check_draw(table, input.train);
  input.test = input.train;
  input.test.kind = choose(table, "test_draw", kinds, input.train.kind);
  read_range(table, "test_low", "test_high", "test_step", input.test);
  check_draw(table, input.test);
  check_steps(table, input);
  return input;
}

SuiteProblem read_problem(const TomlTable& table, const SuiteProblem& defaults) {
  SuiteProblem problem = defaults;
  table.require("name");
  table.read("name", problem.name);
  require_plain_name(problem.name, "a problem", table.place("name"));
  table.read("note", problem.note);
  table.read("law", problem.law);
  problem.law_place = table.place("law");
  table.read("unit", problem.unit);
  table.read("file", problem.file);
  table.read("target", problem.target);
  int rows = static_cast<int>(problem.rows);
  int test_rows = static_cast<int>(problem.test_rows);
  table.read("rows", rows, 1, kMostRows);
  table.read("test_rows", test_rows, 1, kMostRows);
  problem.rows = static_cast<std::size_t>(rows);
  problem.test_rows = static_cast<std::size_t>(test_rows);
  std::vector<std::string> keys = {"name", "unit", "meaning", "draw",
                                   "sign", "low",  "high",    "step"};
  keys.insert(keys.end(), kTestKeys.begin(), kTestKeys.end());
  bool says_test = false;
  for (const TomlTable& input : table.array_of_tables("inputs", keys)) {
    problem.inputs.push_back(read_input(input));
    says_test = says_test || says_test_points(input);
  }
  set_lattice_tests(table, problem, says_test);
  check_lattice(table, problem, &SuiteInput::train);
  check_lattice(table, problem, &SuiteInput::test);
  if (problem.file.empty() && (problem.law.empty() || problem.inputs.empty())) {
    throw_bad_input(fmt::format("problem '{}' has no data", problem.name), table.place(),
                    "give it 'law' and 'inputs', or 'file'");
  }
  check_rows(table, problem, "rows", problem.rows, &SuiteInput::train);
  check_rows(table, problem, "test_rows", problem.test_rows, &SuiteInput::test);
  return problem;
}

SuiteReference read_reference(const TomlTable& table) {
  for (const char* key : {"method", "seconds", "recovered"}) table.require(key);
  SuiteReference reference;
  table.read("method", reference.method);
  table.read("seconds", reference.seconds, 0, kLargest);
  table.read("recovered", reference.recovered, 0, 1);
  reference.low = reference.high = reference.recovered;
  table.read("low", reference.low, 0, 1);
  table.read("high", reference.high, 0, 1);
  return reference;
}

PublishedTable read_published(const TomlTable& file) {
  const TomlTable table =
      file.table("published", {"file", "r2", "seconds", "symbolic", "where", "note"});
  PublishedTable published;
  table.require("file");
  table.read("file", published.file);
  table.read("r2", published.r2);
  table.read("seconds", published.seconds);
  table.read("symbolic", published.symbolic);
  table.read("where", published.where);
  table.read("note", published.note);
  if (!published.where.empty() && published.where.find('=') == std::string::npos) {
    throw_bad_input(fmt::format("'{}' says no value", published.where), table.place("where"),
                    "where = \"COLUMN=VALUE\"");
  }
  return published;
}

}  // namespace

double lattice_points(const Draw& draw) {
  constexpr double kRounding = 1e-9;  // 0 to 1 by 0.1 are eleven points: 0.1 is no binary fraction
  return draw.kind == Draw::Kind::lattice
             ? std::floor((draw.high - draw.low) / draw.step * (1 + kRounding)) + 1
             : 1;
}

const SuiteProblem& Suite::find(std::string_view problem) const {
  std::vector<std::string> names;
  for (const SuiteProblem& one : problems) {
    if (one.name == problem) return one;
    names.push_back(one.name);
  }
  throw_bad_input(fmt::format("suite '{}' has no problem '{}'", name, problem), {},
                  did_you_mean(problem, names));
}

const std::vector<std::string>& suite_keys() {
  static const std::vector<std::string> kKeys = {
      "name",      "summary",    "source", "recovered_below", "rows",
      "test_rows", "test_share", "splits", "standardise",     "reference_note"};
  return kKeys;
}

Suite read_suite(std::string_view toml, const std::string& file_name) {
  const toml::table root = parse_toml(toml, file_name);
  const TomlTable file(root, file_name, "",
                       {"suite", "problem", "reference", "published", "grid", "budget", "retry",
                        "method", "external", "operator_set"});
  file.require("suite");
  const TomlTable head = file.table("suite", suite_keys());
  head.require("name");
  Suite suite;
  suite.identity = key_of(toml);
  SuiteProblem defaults;
  head.read("name", suite.name);
  require_plain_name(suite.name, "a suite", head.place("name"));
  head.read("summary", suite.summary);
  head.read("source", suite.source);
  head.read("recovered_below", suite.recovered_below, 0, 1);
  head.read("test_share", suite.test_share, 0.01, 0.9);
  head.read("standardise", suite.standardise);
  head.read("splits", defaults.splits);
  head.read("reference_note", suite.reference_note);
  int rows = 0;
  int test_rows = 0;
  head.read("rows", rows, 1, kMostRows);
  head.read("test_rows", test_rows, 1, kMostRows);
  defaults.rows = static_cast<std::size_t>(rows);
  defaults.test_rows = static_cast<std::size_t>(test_rows);
  std::set<std::string> seen;
  for (const TomlTable& table : file.array_of_tables(
           "problem",
           {"name", "note", "law", "unit", "file", "target", "rows", "test_rows", "inputs"})) {
    suite.problems.push_back(read_problem(table, defaults));
    if (!seen.insert(suite.problems.back().name).second) {
      throw_bad_input(fmt::format("two problems are called '{}'", suite.problems.back().name),
                      table.place("name"), "give one of them another name");
    }
  }
  check_default_rows(head, suite, "rows", &SuiteInput::train);
  check_default_rows(head, suite, "test_rows", &SuiteInput::test);
  for (const TomlTable& table :
       file.array_of_tables("reference", {"method", "seconds", "recovered", "low", "high"})) {
    suite.references.push_back(read_reference(table));
  }
  if (file.has("published")) suite.published = read_published(file);
  return suite;
}

}  // namespace tribench::suite
