// SPDX-License-Identifier: MIT
#include "harness/data_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/text.hpp"
#include "harness/catalogue.hpp"

namespace tribench {
namespace {

std::vector<user::DataSource> sources_of(const std::vector<std::string>& named,
                                         const std::string& option) {
  std::vector<user::DataSource> sources;
  for (const std::string& one : named) {
    for (user::DataSource& source : user::find_sources(one, option)) {
      if (!is_utf8(source.file.string())) {  // the run's grid, which is TOML, could not name it
        throw_bad_input("the file's name is not UTF-8", source.file.string(), "rename it");
      }
      sources.push_back(std::move(source));
    }
  }
  return sources;
}

void add_problem(Grid& grid, user::UserProblem problem) {
  if (grid.own_problem(problem.name) != nullptr) {
    throw_bad_input(fmt::format("two files would be problem '{}'", problem.name), "--data-file",
                    "rename one, or make one problem of them all by --together NAME");
  }
  grid.problems.push_back(problem.name);
  grid.own.push_back(std::move(problem));
}

// A column that says by its name what a movement is, and is not used as one.
bool has_idle_movements(const user::UserProblem& own) {
  if (!own.group.empty()) return false;
  DataOptions by_name = own.reading;
  by_name.names_tell = true;
  by_name.roles.clear();
  const std::vector<std::filesystem::path> first = {own.files.front().file};
  try {
    return read_data(first, by_name, std::vector<std::string>{own.target}).has_movements;
  } catch (const Error&) {
    return false;  // its names say something that it does not keep to
  }
}

}  // namespace

Grid make_data_grid(const DataGridRequest& request, const Registry& registry) {
  Grid grid;
  std::vector<user::DataSource> sources = sources_of(request.files, "--data-file");
  user::UserProblem problem = request.problem;
  problem.passed_over = user::take_out_notes(sources, problem.target);
  if (!request.test.empty()) {
    problem.held_out.kind = user::HeldOut::Kind::files;
    problem.held_out.files = sources_of(request.test, "--test");
    for (std::filesystem::path& note :
         user::take_out_notes(problem.held_out.files, problem.target)) {
      problem.passed_over.push_back(std::move(note));
    }
    user::leave_out_tests(sources, problem.held_out.files, "--test");
  }
  if (!request.together.empty()) {
    require_plain_name(request.together, "a problem", "--together");
    problem.name = request.together;
    problem.files = sources;
    add_problem(grid, std::move(problem));
  } else {
    for (const user::DataSource& source : sources) {
      problem.name = user::name_of_file(source.file);
      problem.files = {source};
      add_problem(grid, problem);
    }
  }
  const bool one_name = grid.own.size() == 1;
  grid.name = one_name ? grid.own.front().name : user::name_of_file(request.files.front());

  std::vector<std::string> names;
  for (const AlgorithmEntry& entry : registry.entries()) names.push_back(entry.name);
  for (const std::string& name : pick_names(request.methods, names, "method", "--methods")) {
    grid.methods.push_back({name, name, {}, registry.find(name).fixed_form, {}, {}, {}});
  }
  std::vector<std::string> set_names;
  for (const OperatorSet& set : operator_sets()) set_names.push_back(set.name());
  for (const std::string& name :
       pick_names(request.operators, set_names, "operator set", "--operators")) {
    grid.operators.push_back(find_operator_set(name));
  }
  return grid;
}

std::vector<std::string> reading_notes(const Grid& grid) {
  std::vector<std::string> notes;
  std::set<std::filesystem::path> passed_over;  // each is told once
  for (const user::UserProblem& own : grid.own) {
    for (const std::filesystem::path& file : own.passed_over) {
      if (!passed_over.insert(file).second) continue;
      notes.push_back(
          fmt::format("{} is left out: it has no column '{}'", file.string(), own.target));
    }
    const DataFile rows = at_place(own.place, [&] {
      DataFile read = user::read_user_rows(own);
      user::check_user_problem(own, read.data, law_reader());
      return read;
    });
    for (const std::string& warning : rows.warnings) {
      notes.push_back(fmt::format("{}: {}", own.name, warning));
    }
    if (rows.dropped_rows > 0) {
      notes.push_back(
          fmt::format("{}: {} rows with missing values dropped", own.name, rows.dropped_rows));
    }
    if (!rows.has_movements && has_idle_movements(own)) {
      notes.push_back(fmt::format(
          "{}: a column says which movement a row belongs to; group by it (--group, group = ), so "
          "that no movement is parted by the split",
          own.name));
    }
  }
  return notes;
}

}  // namespace tribench
