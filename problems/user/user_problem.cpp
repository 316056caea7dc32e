// SPDX-License-Identifier: MIT
#include "problems/user/user_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "foundation/suggestion.hpp"
#include "problems/data_problem.hpp"
#include "problems/file_hash.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/table.hpp"

namespace tribench::user {
namespace {

constexpr const char* kDataset = "own";

void require_unchanged(std::span<const DataSource> files) {
  for (const DataSource& source : files) {
    const std::string found = sha256_of(source.file);
    if (found == source.sha256) continue;
    throw_bad_input(
        fmt::format("the file has changed: its SHA-256 is {}, not {}", found, source.sha256),
        source.file.string(), "put the file back, or start a new run without its sha256");
  }
}

std::vector<std::filesystem::path> paths_of(std::span<const DataSource> sources) {
  std::vector<std::filesystem::path> paths;
  for (const DataSource& source : sources) paths.push_back(source.file);
  return paths;
}

// Text and numbers alike: "3", "3.0" and 3 are the same value.
std::string label_of(double value) { return fmt::format("{}", value); }

std::string label_of(const std::string& text) {
  double value = 0;
  if (read_cell(text, false, value) == CellKind::number) return label_of(value);
  return text;
}

std::vector<std::string> labels_in(const DataFile& rows, const std::string& column) {
  std::vector<std::string> labels;
  for (const TextColumn& text : rows.texts) {
    if (text.name == column) return text.values;
  }
  for (const double value : rows.data.at(column).values) labels.push_back(label_of(value));
  return labels;
}

// Rows of a group come to stand together, groups in the order of their first rows.
void group_rows(DataFile& rows, const std::vector<std::string>& labels) {
  std::map<std::string, int> number;
  rows.data.movement_names.clear();
  for (std::size_t r = 0; r < labels.size(); ++r) {
    const auto [place, is_new] = number.try_emplace(labels[r], static_cast<int>(number.size()));
    if (is_new) rows.data.movement_names.push_back(labels[r]);
    rows.data.movement[r] = place->second;
  }
  std::vector<std::size_t> order(labels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t r) { return rows.data.movement[r]; });
  const auto sort = [&order](auto& values) {
    auto sorted = values;
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
    values = std::move(sorted);
  };
  for (Channel& channel : rows.data.channels) sort(channel.values);
  for (TextColumn& text : rows.texts) sort(text.values);
  sort(rows.data.movement);
}

void part_rows(Dataset& data) {
  data.movement_names.clear();
  for (std::size_t r = 0; r < data.rows(); ++r) {
    data.movement[r] = static_cast<int>(r);
    data.movement_names.push_back(std::to_string(r + 1));
  }
}

// The columns that the problem needs; nothing where the inputs are all that there are.
std::optional<std::vector<std::string>> used_columns(const UserProblem& own) {
  if (own.inputs.empty()) return std::nullopt;
  std::vector<std::string> used = own.inputs;
  used.push_back(own.target);
  for (const std::string* more : {&own.group, &own.category, &own.held_out.column}) {
    if (!more->empty()) used.push_back(*more);
  }
  return used;
}

// The column that has the role movement is no channel: what it says row by row is kept where a
// group or a split asks for it.
void keep_movement_names(const UserProblem& own, DataFile& rows) {
  const auto column = std::ranges::find(rows.readings, Role::movement, &ColumnReading::role);
  if (column == rows.readings.end()) return;
  if (column->column != own.group && column->column != own.held_out.column) return;
  TextColumn names{column->column, {}};
  for (const int movement : rows.data.movement) {
    names.values.push_back(rows.data.movement_names[static_cast<std::size_t>(movement)]);
  }
  rows.texts.push_back(std::move(names));
}

DataFile read_rows(const UserProblem& own, std::span<const DataSource> sources) {
  DataFile rows = read_named_columns(paths_of(sources), own.reading, used_columns(own));
  rows.data.name = sources.size() == 1 ? sources.front().file.string() : own.name;
  keep_movement_names(own, rows);
  if (!own.group.empty()) {
    group_rows(rows, labels_in(rows, own.group));
  } else if (!rows.has_movements && sources.size() == 1) {
    part_rows(rows.data);
  }
  return rows;
}

std::vector<std::string> inputs_of(const UserProblem& own, const Dataset& data) {
  if (!own.inputs.empty()) return own.inputs;
  return other_columns(data, {own.target, own.group, own.category, own.held_out.column},
                       own.reading.where);
}

suite::Law law_of(const UserProblem& own, const suite::LawReader& laws,
                  const std::vector<std::string>& inputs) {
  if (!laws) throw Error(ErrorKind::failed, "no reader of laws was handed in", own.name);
  return at_place(fmt::format("the law of problem '{}'", own.name),
                  [&] { return laws(own.law, inputs); });
}

// The law's value in every row; none where it is not known.
std::vector<double> truth_of(const UserProblem& own, const suite::LawReader& laws,
                             const std::vector<std::string>& inputs, const Dataset& data) {
  if (own.law.empty()) return {};
  const suite::Law law = law_of(own, laws, inputs);
  std::vector<std::vector<double>> columns;
  const ChannelIndex channels(data);
  for (const std::string& input : inputs) columns.push_back(input_values(channels, input));
  std::vector<double> truth;
  std::vector<double> point(inputs.size());
  for (std::size_t r = 0; r < data.rows(); ++r) {
    for (std::size_t j = 0; j < point.size(); ++j) point[j] = columns[j][r];
    truth.push_back(law(point));
    if (std::isfinite(truth.back())) continue;
    throw_bad_input(fmt::format("the law '{}' is {} in row {}", own.law, truth.back(), r + 1),
                    data.name, "check the law's constants, or leave it out");
  }
  return truth;
}

void check_units_and_box(const UserProblem& own, const std::vector<std::string>& inputs) {
  for (const auto& [column, unit] : own.units) {
    if (column == own.target || std::ranges::count(inputs, column) > 0) continue;
    throw_bad_input(fmt::format("a unit is given for '{}', which is no input", column), own.name,
                    did_you_mean(column, inputs));
  }
  for (const auto& [column, range] : own.box) {
    if (std::ranges::count(inputs, column) > 0) continue;
    throw_bad_input(fmt::format("the box has '{}', which is no input", column), own.name,
                    did_you_mean(column, inputs));
  }
}

void check_gravity(const UserProblem& own, const suite::LawReader& laws) {
  if (!own.motion || own.motion->gravity.empty() || !laws) return;
  try {
    laws(own.motion->gravity, std::vector<std::string>{"q"});
  } catch (const Error& error) {
    throw_bad_input(error.what(), fmt::format("the gravity of problem '{}'", own.name),
                    "write a formula in q, the position");
  }
}

void set_units_and_box(const UserProblem& own, Problem& problem) {
  check_units_and_box(own, problem.input_names());
  for (const auto& [column, unit] : own.units) {
    const auto input = std::ranges::find(problem.inputs, column, &Input::name);
    if (input != problem.inputs.end()) {
      input->unit = unit;
    } else {
      problem.target_unit = unit;
    }
  }
  for (const auto& [column, range] : own.box) {
    const auto input = std::ranges::find(problem.inputs, column, &Input::name);
    if (input->low < range.first || input->high > range.second) {
      throw_bad_input(fmt::format("'{}' is from {} to {} in the rows and from {} to {} in the box",
                                  column, input->low, input->high, range.first, range.second),
                      own.name, "widen the box, or leave rows out by where = \"COLUMN=VALUE\"");
    }
    input->low = range.first;
    input->high = range.second;
  }
}

// Of the movements.
std::vector<char> test_by_values(const UserProblem& own, const DataFile& rows) {
  const std::vector<std::string> labels = labels_in(rows, own.held_out.column);
  std::set<std::string> wanted;
  for (const std::string& value : own.held_out.values) wanted.insert(label_of(value));
  std::vector<char> test(rows.data.movement_names.size(), 2);
  for (std::size_t r = 0; r < labels.size(); ++r) {
    char& mark = test[static_cast<std::size_t>(rows.data.movement[r])];
    const char now = wanted.contains(label_of(labels[r])) ? 1 : 0;
    if (mark != 2 && mark != now) {
      throw_bad_input(
          fmt::format("group '{}' has rows on both sides of the split by '{}'",
                      rows.data.movement_names[static_cast<std::size_t>(rows.data.movement[r])],
                      own.held_out.column),
          rows.data.name, "a group is kept whole: split by it, or give another group");
    }
    mark = now;
  }
  const auto tested = std::ranges::count(test, 1);
  if (tested == 0 || tested == std::ssize(test)) {
    const std::set<std::string> there(labels.begin(), labels.end());
    std::vector<std::string> shown(there.begin(), there.end());
    if (shown.size() > 20) shown.resize(20);
    throw_bad_input(fmt::format("{} of {} groups have '{}' = {}", tested, test.size(),
                                own.held_out.column, fmt::join(own.held_out.values, " or ")),
                    rows.data.name, fmt::format("values there: {}", fmt::join(shown, ", ")));
  }
  return test;
}

std::vector<char> test_movements(const UserProblem& own, const DataFile& rows, std::uint64_t seed) {
  if (own.held_out.kind == HeldOut::Kind::values) return test_by_values(own, rows);
  if (rows.data.movement_names.size() < 2) {
    throw_bad_input("there is one group of rows: none can be held out", rows.data.name,
                    "give more, or 'group' a column that tells several apart");
  }
  const std::vector<std::uint64_t>& seeds = own.held_out.seeds;
  if (!seeds.empty()) seed = seeds[(seed + seeds.size() - 1) % seeds.size()];
  return draw_test_movements(rows.data, own.held_out.share,
                             RandomStream(key_of(own.name)).split(seed).split("split"));
}

void check_motion_roles(const Dataset& data) {
  for (const Role role : {Role::time, Role::position, Role::motor_torque}) {
    if (data.find(role) != nullptr) continue;
    throw_bad_input(
        fmt::format("no column has the role {}", role_name(role)), data.name,
        fmt::format("motion is simulated: say roles = \"COLUMN={}\" (with its unit), or "
                    "leave out 'motion'",
                    role_name(role)));
  }
}

// What the motion is judged on: rows of test movements with every column. Where each row is a group
// of its own, what tests is one recording.
void set_motion(const UserProblem& own, const Dataset& data, const std::vector<char>& test,
                const suite::LawReader& laws, Problem& problem) {
  if (!own.motion) return;
  check_motion_roles(data);
  check_gravity(own, laws);
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    if (test.empty() || test[static_cast<std::size_t>(data.movement[r])] != 0) kept.push_back(r);
  }
  Dataset tested = select_rows({data, {}}, kept).data;
  if (data.movement_names.size() == data.rows()) {
    if (own.held_out.kind == HeldOut::Kind::share) {
      throw_bad_input(
          "rows are held out one by one, and motion goes on from row to row",
          fmt::format("the split of problem '{}'", own.name),
          "give 'group', a column with the role movement, or a split by a column or file");
    }
    tested.movement.assign(tested.rows(), 0);
    tested.movement_names = {own.name};
  }
  const auto rows = std::make_shared<const MotionCase>(MotionCase{std::move(tested), *own.motion});
  problem.motion = [rows] { return *rows; };
}

// The category travels with the rows as the last input, which its unit tells from the others.
void add_category(const UserProblem& own, const DataFile& rows, std::vector<std::string>& names) {
  if (own.category.empty()) return;
  for (const TextColumn& text : rows.texts) {
    if (text.name != own.category) continue;
    throw_bad_input(fmt::format("the category '{}' holds text", own.category), rows.data.name,
                    "give each category a number in a column of its own");
  }
  names.push_back(own.category);
}

}  // namespace

std::string UserProblem::hash() const {
  constexpr std::size_t kDigits = 12;
  std::string all;
  for (const DataSource& source : files) all += source.sha256;
  for (const DataSource& source : held_out.files) all += source.sha256;
  const bool single = files.size() == 1 && held_out.files.empty();
  return (single ? all : sha256_of_text(all)).substr(0, kDigits);
}

void require_unchanged(const UserProblem& own) {
  require_unchanged(own.files);
  require_unchanged(own.held_out.files);
}

std::vector<std::string> other_columns(const Dataset& data, std::set<std::string> taken,
                                       const std::string& where) {
  taken.insert(where.substr(0, where.rfind('=')));
  std::vector<std::string> columns;
  for (const Channel& channel : data.channels) {
    if (channel.role != Role::time && !taken.contains(channel.name)) {
      columns.push_back(channel.name);
    }
  }
  return columns;
}

DataFile read_user_rows(const UserProblem& own) { return read_rows(own, own.files); }

void check_user_problem(const UserProblem& own, const Dataset& data, const suite::LawReader& laws) {
  data.at(own.target);
  std::vector<std::string> inputs = inputs_of(own, data);
  if (!own.law.empty()) law_of(own, laws, inputs);
  check_gravity(own, laws);
  if (!own.category.empty()) inputs.push_back(own.category);
  check_units_and_box(own, inputs);
}

Problem make_user_problem(const UserProblem& own, const suite::LawReader& laws,
                          std::uint64_t seed) {
  require_unchanged(own);
  require_apart(own.files, own.held_out.files, own.name);
  const DataFile rows = read_user_rows(own);
  std::vector<std::string> names = inputs_of(own, rows.data);
  add_category(own, rows, names);
  const KnownDataset known{rows.data, truth_of(own, laws, names, rows.data)};
  std::optional<DataFile> other;
  if (own.held_out.kind == HeldOut::Kind::files) other = read_rows(own, own.held_out.files);
  Problem problem = make_data_problem(rows.data, other ? &other->data : nullptr, own.target, names);
  problem.name = own.name;
  problem.dataset = kDataset;
  Stage& stage = problem.stages.front();
  stage.law = own.law;
  stage.train.truth = known.truth;
  if (other) {
    problem.test.truth = truth_of(own, laws, names, other->data);
    set_motion(own, other->data, {}, laws, problem);
  } else if (own.held_out.kind != HeldOut::Kind::nothing) {
    const std::vector<char> test = test_movements(own, rows, seed);
    std::vector<char> train(test);
    for (char& mark : train) mark = mark == 0 ? 1 : 0;
    stage.train = make_table(known, problem.inputs, own.target, train);
    problem.test = make_table(known, problem.inputs, own.target, test);
    set_motion(own, rows.data, test, laws, problem);
  }
  set_units_and_box(own, problem);
  if (!own.category.empty()) problem.inputs.back().unit = kCategoryUnit;
  return problem;
}

void add_entries(std::vector<ProblemEntry>& entries, std::span<const UserProblem> own,
                 const suite::LawReader& laws) {
  for (const UserProblem& one : own) {
    const auto kept = std::make_shared<const UserProblem>(one);
    const std::string summary =
        fmt::format("{} of {}", one.target,
                    one.files.size() == 1 ? one.files.front().file.string()
                                          : fmt::format("{} files", one.files.size()));
    entries.push_back(
        {one.name, summary,
         [kept, laws](std::uint64_t seed) { return make_user_problem(*kept, laws, seed); },
         [kept](std::uint64_t) { return read_user_rows(*kept).data; }, summary});
  }
}

}  // namespace tribench::user
