// SPDX-License-Identifier: MIT
#include "harness/grid_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "foundation/error.hpp"
#include "foundation/glob.hpp"
#include "foundation/suggestion.hpp"
#include "harness/catalogue.hpp"
#include "problems/variant.hpp"

namespace tribench {
namespace {

// None where it cannot be made: the data are not here, say, and its cells will tell.
std::optional<std::vector<std::string>> input_names_of(const Grid& grid, const Catalogue& catalogue,
                                                       const std::string& problem) {
  try {
    const user::UserProblem* own = grid.own_problem(problem);
    return (own != nullptr ? user::make_user_problem(*own, law_reader(), grid.first_seed)
                           : catalogue.find(problem).make(grid.first_seed))
        .input_names();
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void DeclaredNames::add(const std::string& name, const std::string& name_place,
                        const std::string& table_place) {
  if (std::ranges::count(declared_, name, &Declared::name) > 0) {
    throw_bad_input(fmt::format("two {}s are called '{}'", what_, name), name_place,
                    "give one of them another name");
  }
  declared_.push_back({name, table_place});
}

void DeclaredNames::require_named(const std::vector<std::string>& globs) const {
  std::set<std::string> named;
  for (const Declared& one : declared_) {
    const bool is_named = std::ranges::any_of(globs, [&](const std::string& glob) {
      return glob_matches(glob.substr(glob.starts_with('!') ? 1 : 0), one.name);
    });
    if (is_named) named.insert(one.place);
  }
  for (const Declared& one : declared_) {
    if (named.contains(one.place)) continue;
    throw_bad_input(fmt::format("the {} '{}' would not run: '{}' of [grid] does not name it", what_,
                                one.name, key_),
                    one.place,
                    fmt::format("add \"{}\" to '{}', or leave the table out", one.name, key_));
  }
}

void require_inputs_of_prior(const Grid& grid, const Catalogue& catalogue,
                             const std::string& place) {
  std::set<std::string> sought;
  for (const auto& [input, degree] : grid.prior.max_degree) sought.insert(input);
  std::set<std::string> seen;
  std::set<std::string> bases;  // variants have the same inputs
  for (const std::string& problem : grid.problems) {
    if (sought.empty()) return;
    const std::string base = split_variant(problem).first;
    if (!bases.insert(base).second) continue;
    const auto names = input_names_of(grid, catalogue, base);
    if (!names) return;
    seen.insert(names->begin(), names->end());
    for (const std::string& name : *names) sought.erase(name);
  }
  if (sought.empty() || grid.problems.empty()) return;
  const std::vector<std::string> inputs(seen.begin(), seen.end());
  throw_bad_input(fmt::format("'{}' is an input of no problem of the grid", *sought.begin()), place,
                  did_you_mean(*sought.begin(), inputs));
}

void require_readable_laws(const Grid& grid) {
  for (const suite::Suite& suite : grid.suites) {
    for (const suite::SuiteProblem& problem : suite.problems) {
      const std::string name = fmt::format("{}/{}", suite.name, problem.name);
      const bool runs = std::ranges::any_of(
          grid.problems, [&](const std::string& one) { return split_variant(one).first == name; });
      if (runs && problem.file.empty()) suite::read_law_of(problem, law_reader());
    }
  }
}

}  // namespace tribench
