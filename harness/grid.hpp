// SPDX-License-Identifier: MIT
//
// A grid: which problems, methods, operator sets and seeds to cross, and what each cell may spend.
// Read from a TOML file (docs/grid.md, grids/grid.schema.json); unknown keys are refused with the
// nearest name, globs are resolved at once, so that what is held here is what took effect.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/registry.hpp"
#include "harness/cell.hpp"
#include "problems/catalogue.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench {

// What one cell may spend. `evaluations` and `seconds` are told to the method, which stops by
// itself; the others are enforced from outside and cost the cell.
struct CellLimits {
  // More than any machine gets done: where seconds alone are to be spent.
  static constexpr std::uint64_t kAmple = 9'000'000'000'000'000;

  std::uint64_t evaluations = 20'000'000'000;  // node-rows
  double seconds = 60;                         // CPU seconds of the fit
  double wall_seconds = 180;                   // of the whole cell
  double cpu_limit_seconds = 90;               // CPU seconds of the whole cell
  double memory_mib = 2048;
  // Evaluations and seconds are what shall be spent, not what may be (restarts.hpp).
  bool spend = false;

  bool operator==(const CellLimits&) const = default;
};

// The fit stops by itself; judging and slack come on top, in CPU and in wall time.
void set_seconds(CellLimits& limits, double seconds);

// For seconds that somebody named and evaluations that nobody did: where they are to be spent, no
// number of evaluations ends that.
void spend_seconds_alone(CellLimits& limits);

// How often a cell that failed is tried again, by the reason. A cell that failed in a worker that
// had run other cells before is always tried once more in a fresh one, which is not counted here.
struct RetryPolicy {
  int crashed = 0;
  int timeout = 0;
  int cpu_limit = 0;
  int out_of_memory = 0;
  int error = 0;

  bool operator==(const RetryPolicy&) const = default;
};

// A method as the grid runs it: an algorithm with its parameters, or a program.
struct Method {
  std::string name;
  std::string algorithm;  // of the registry; empty for a program
  std::map<std::string, ParameterValue> parameters;
  bool fixed_form = false;

  // Of a program only.
  std::vector<std::string> command;
  std::vector<std::string> operators;  // names of the operator sets it can use
  std::optional<CellLimits> limits;    // in place of the grid's

  bool is_external() const { return !command.empty(); }
};

// What is held to be known before the data, the same for every method: the highest power of an
// input, by the input's name. A problem without an input of that name is not concerned; one of the
// grid's problems has it.
struct Prior {
  std::map<std::string, int> max_degree;

  bool operator==(const Prior&) const = default;
};
void apply_prior(const Prior& prior, Problem& problem);

// What a fixed form may use: every operation, under the name "-".
OperatorSet fixed_form_operators();

struct Grid {
  static constexpr std::size_t kMostCells = 1'000'000;  // each about 1 kB of memory, 2 kB of disk

  std::string name;
  std::vector<std::string> problems;
  std::vector<Method> methods;
  std::vector<OperatorSet> operators;
  std::uint64_t first_seed = 1;
  std::uint64_t seed_count = 1;
  std::vector<std::string> quarantine;  // globs over cell keys that are not run
  CellLimits limits;
  RetryPolicy retry;
  Prior prior;
  // Published figures that the report sets beside the run's (reports/published.hpp): the file as
  // the grid names it, and its text; both empty where there is none.
  std::string reference_file;
  std::string reference;

  std::vector<suite::Suite> suites;    // those that have problems of this grid
  std::vector<user::UserProblem> own;  // problems of this grid that it brings itself

  // The first cell of each problem, method and operator set; from seed to seed all else is equal.
  std::vector<Cell> series() const;
  // Every cell, in the order of the results: problem, method, operator set, seed. Some 150 bytes
  // each: for a look at one after the other there are the series.
  std::vector<Cell> cells() const;
  std::size_t cell_count() const;
  // Throws Error (bad_input) at `place` where there is no cell, or more than a run can hold.
  void require_runnable(std::string_view place) const;
  // Names of the operator sets that a method runs with.
  std::vector<std::string> sets_of(const Method& method) const;
  const Method& method(std::string_view method_name) const;
  OperatorSet operator_set(std::string_view set_name) const;  // "-" is everything
  // Nothing for a problem of the catalogue.
  const user::UserProblem* own_problem(std::string_view problem) const;
  CellLimits limits_of(const Method& method) const { return method.limits.value_or(limits); }
  // A pattern is held against the key, and of a problem of the grid's own against the key without
  // the hash of its data too.
  bool quarantined(const Cell& cell) const;
  // The patterns that leave out no cell, and those that do. Cost: every cell's key, where there
  // are patterns.
  std::vector<std::string> idle_quarantine() const;
  std::vector<std::string> effective_quarantine() const;
};

// The names that globs pick, in the order of `known`; "!GLOB" leaves out of what those before it
// have picked. Throws Error (bad_input) with the place and the nearest name for a glob that matches
// nothing, and where nothing is left. `what`: "problem", "method".
std::vector<std::string> pick_names(const std::vector<std::string>& globs,
                                    const std::vector<std::string>& known, std::string_view what,
                                    const std::string& place);

// Throws Error (bad_input) with file, line and the nearest name. Leaves `reference` empty.
Grid parse_grid(std::string_view toml, const std::string& file_name, const Registry& registry,
                const Catalogue& catalogue);
// Reads the published figures too, from beside the file.
Grid load_grid(const std::filesystem::path& file, const Registry& registry,
               const Catalogue& catalogue);

// The grid as it took effect, as TOML; parse_grid(print_grid(g)) gives the same cells and limits.
// Published figures are named as they lie beside it in a run's folder, data files from `folder`,
// where the text will lie.
std::string print_grid(const Grid& grid, const std::filesystem::path& folder = ".");
// The same wherever its files lie: what makes two runs the same run.
std::string print_grid_identity(const Grid& grid);

}  // namespace tribench
