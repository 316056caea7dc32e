// SPDX-License-Identifier: MIT
#include "harness/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "foundation/error.hpp"
#include "foundation/glob.hpp"
#include "foundation/suggestion.hpp"
#include "problems/variant.hpp"

namespace tribench {
namespace {

// What a pattern of the quarantine is held against: nobody writes down what a file hashes to.
class CellName {
 public:
  explicit CellName(const Cell& cell) : key_(cell.key()) {
    if (cell.data.empty()) return;
    Cell bare = cell;
    bare.data.clear();
    without_hash_ = bare.key();
  }
  bool is_matched_by(const std::string& glob) const {
    return glob_matches(glob, key_) ||
           (!without_hash_.empty() && glob_matches(glob, without_hash_));
  }

 private:
  std::string key_;
  std::string without_hash_;  // empty where the key has none
};

}  // namespace

void set_seconds(CellLimits& limits, double seconds) {
  limits.seconds = seconds;
  limits.cpu_limit_seconds = 1.5 * seconds + 30;
  limits.wall_seconds = 3 * seconds + 60;
}

void spend_seconds_alone(CellLimits& limits) {
  if (limits.spend && limits.evaluations == CellLimits().evaluations) {
    limits.evaluations = CellLimits::kAmple;
  }
}

void apply_prior(const Prior& prior, Problem& problem) {
  for (Input& input : problem.inputs) {
    const auto found = prior.max_degree.find(input.name);
    if (found != prior.max_degree.end()) input.max_degree = found->second;
  }
}

std::vector<std::string> pick_names(const std::vector<std::string>& globs,
                                    const std::vector<std::string>& known, std::string_view what,
                                    const std::string& place) {
  std::set<std::string> picked;
  for (const std::string& text : globs) {
    const bool leaves_out = text.starts_with('!');
    const std::string glob = text.substr(leaves_out ? 1 : 0);
    bool found = false;
    for (const std::string& name : known) {
      if (!glob_matches(glob, name)) continue;
      if (leaves_out) {
        picked.erase(name);
      } else {
        picked.insert(name);
      }
      found = true;
    }
    if (found) continue;
    throw_bad_input(fmt::format("there is no {} '{}'", what, glob), place,
                    did_you_mean(glob, known));
  }
  if (picked.empty() && !globs.empty()) {
    throw_bad_input(fmt::format("no {} is left", what), place,
                    "'!' leaves out of what stands before it, as in [\"*\", \"!relay\"]");
  }
  std::vector<std::string> ordered;
  std::ranges::copy_if(known, std::back_inserter(ordered),
                       [&](const std::string& name) { return picked.contains(name); });
  return ordered;
}

OperatorSet fixed_form_operators() {
  std::vector<Op> all;
  for (int op = 0; op < kOpCount; ++op) {
    if (arity(static_cast<Op>(op)) > 0) all.push_back(static_cast<Op>(op));
  }
  return {kFixedForm, "every operation", all};
}

std::vector<std::string> Grid::sets_of(const Method& method) const {
  if (method.fixed_form) return {kFixedForm};
  std::vector<std::string> sets;
  for (const OperatorSet& set : operators) {
    const bool usable =
        !method.is_external() || std::ranges::count(method.operators, set.name()) > 0;
    if (usable) sets.push_back(set.name());
  }
  return sets;
}

std::size_t Grid::cell_count() const {
  std::size_t of_a_seed = 0;
  for (const Method& method : methods) of_a_seed += problems.size() * sets_of(method).size();
  return of_a_seed * seed_count;
}

void Grid::require_runnable(std::string_view place) const {
  const std::size_t cells = cell_count();
  if (cells == 0) {
    throw_bad_input("the grid has no cell: no problem, no method or no operator set is named",
                    place, "name some; '*' names all");
  }
  if (cells > kMostCells) {
    throw_bad_input(fmt::format("the grid has {} cells", cells), place,
                    fmt::format("use at most {}: split it into several grids", kMostCells));
  }
}

std::vector<Cell> Grid::series() const {
  std::vector<Cell> all;
  for (const std::string& problem : problems) {
    const user::UserProblem* brought = own_problem(problem);
    const std::string data = brought == nullptr ? std::string() : brought->hash();
    for (const Method& method : methods) {
      for (const std::string& set : sets_of(method)) {
        all.push_back({problem, method.name, set, first_seed, data});
      }
    }
  }
  return all;
}

std::vector<Cell> Grid::cells() const {
  std::vector<Cell> all;
  all.reserve(cell_count());
  for (const Cell& first : series()) {
    for (std::uint64_t i = 0; i < seed_count; ++i) {
      all.push_back(first);
      all.back().seed += i;
    }
  }
  return all;
}

const Method& Grid::method(std::string_view method_name) const {
  for (const Method& method : methods) {
    if (method.name == method_name) return method;
  }
  throw Error(ErrorKind::failed, fmt::format("the grid has no method '{}'", method_name));
}

OperatorSet Grid::operator_set(std::string_view set_name) const {
  if (set_name == kFixedForm) {
    return fixed_form_operators();
  }
  for (const OperatorSet& set : operators) {
    if (set.name() == set_name) return set;
  }
  throw Error(ErrorKind::failed, fmt::format("the grid has no operator set '{}'", set_name));
}

const user::UserProblem* Grid::own_problem(std::string_view problem) const {
  const auto found = std::ranges::find(own, split_variant(problem).first, &user::UserProblem::name);
  return found == own.end() ? nullptr : &*found;
}

bool Grid::quarantined(const Cell& cell) const {
  return std::ranges::any_of(quarantine, [key = CellName(cell)](const std::string& glob) {
    return key.is_matched_by(glob);
  });
}

std::vector<std::string> Grid::idle_quarantine() const {
  std::vector<std::string> idle = quarantine;
  if (idle.empty()) return idle;
  for (const Cell& cell : cells()) {
    const CellName key(cell);
    std::erase_if(idle, [&key](const std::string& glob) { return key.is_matched_by(glob); });
    if (idle.empty()) break;
  }
  return idle;
}

std::vector<std::string> Grid::effective_quarantine() const {
  const std::vector<std::string> idle = idle_quarantine();
  std::vector<std::string> effective;
  std::ranges::copy_if(quarantine, std::back_inserter(effective), [&](const std::string& glob) {
    return std::ranges::count(idle, glob) == 0;
  });
  return effective;
}

}  // namespace tribench
