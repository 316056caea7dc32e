// SPDX-License-Identifier: MIT
#include "problems/user/user_problem_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "problems/preparation/data_options_toml.hpp"

namespace tribench::user {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& problem_keys() {
  static const std::vector<std::string> kKeys = [] {
    std::vector<std::string> keys = {"name",   "file",   "files",  "folder", "glob",
                                     "sha256", "target", "inputs", "group",  "split",
                                     "law",    "units",  "box",    "motion", "category"};
    keys.insert(keys.end(), data_option_keys().begin(), data_option_keys().end());
    return keys;
  }();
  return kKeys;
}

// The files that one of file, files, folder and glob names; none where the table has none of them.
std::vector<DataSource> read_sources(const TomlTable& table, const fs::path& folder) {
  std::vector<std::string> named;
  std::string key;
  for (const char* one : {"file", "files", "folder", "glob"}) {
    if (!table.has(one)) continue;
    if (!key.empty()) {
      throw_bad_input(fmt::format("'{}' and '{}' both name the data", key, one), table.place(one),
                      "give one of file, files, folder, glob");
    }
    key = one;
    if (key == "files") {
      table.read(key, named);
    } else {
      table.read(key, named.emplace_back());
    }
  }
  if (key.empty()) return {};
  std::vector<DataSource> sources;
  for (const std::string& name : named) {
    if (name.empty()) throw_bad_input(fmt::format("'{}' is empty", key), table.place(key));
    if (table.has("sha256")) {  // whoever reads them looks for them
      sources.push_back({folder / name, {}});
      continue;
    }
    for (DataSource& source : find_sources(folder / name, table.place(key))) {
      sources.push_back(std::move(source));
    }
  }
  if (sources.empty()) throw_bad_input(fmt::format("'{}' names no file", key), table.place(key));
  if (!table.has("sha256")) return sources;
  std::vector<std::string> hashes;
  table.read("sha256", hashes);
  if (hashes.size() != sources.size()) {
    throw_bad_input(fmt::format("{} hashes for {} files", hashes.size(), sources.size()),
                    table.place("sha256"), "give one for each file, in their order, or none");
  }
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i].sha256 = std::move(hashes[i]);
  return sources;
}

HeldOut read_held_out(const TomlTable& table, const fs::path& folder) {
  HeldOut held_out;
  const bool by_file =
      table.has("file") || table.has("files") || table.has("folder") || table.has("glob");
  const int ways = (table.has("share") || table.has("seeds") ? 1 : 0) +
                   (table.has("column") ? 1 : 0) + (by_file ? 1 : 0);
  if (ways > 1) {
    throw_bad_input("a split is by share, by a column or by files, not by several of them",
                    table.place(), "as in split = { share = 0.25, seeds = [1, 2, 3] }");
  }
  table.read("share", held_out.share, 0.001, 0.999);
  table.read("seeds", held_out.seeds);
  if (table.has("column")) {
    held_out.kind = HeldOut::Kind::values;
    table.require("values");
    table.read("column", held_out.column);
    table.read("values", held_out.values);
  }
  if (by_file) {
    held_out.kind = HeldOut::Kind::files;
    held_out.files = read_sources(table, folder);
  }
  return held_out;
}

std::map<std::string, std::string> read_units(const TomlTable& table) {
  std::map<std::string, std::string> units;
  for (const auto& [column, value] : table.values("units")) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) {
      throw_bad_input(fmt::format("the unit of '{}' is no text", column), table.place("units"),
                      "as in units = { v = \"m/s\" }");
    }
    units[column] = *text;
  }
  return units;
}

std::map<std::string, std::pair<double, double>> read_box(const TomlTable& table) {
  std::map<std::string, std::pair<double, double>> box;
  const std::vector<std::string> inputs = table.keys("box");
  const TomlTable inner = table.table("box", inputs);
  for (const std::string& input : inputs) {
    std::vector<double> range;
    inner.read(input, range);
    if (range.size() != 2 || !(range[0] < range[1])) {
      throw_bad_input(fmt::format("the range of '{}' is no [low, high]", input), inner.place(input),
                      "as in box = { v = [-2, 2] }");
    }
    box[input] = {range[0], range[1]};
  }
  return box;
}

std::optional<MotionTerms> read_motion(const TomlTable& problem) {
  if (!problem.has("motion")) return {};
  constexpr double kLargest = 1e12;
  const TomlTable table = problem.table("motion", {"gravity", "inertia", "hold", "horizon"});
  MotionTerms terms;
  table.read("gravity", terms.gravity);
  table.read("inertia", terms.inertia, 0, kLargest);
  table.read("hold", terms.hold);
  table.read("horizon", terms.horizon_s, 0, kLargest);
  return terms;
}

toml::table motion_table(const MotionTerms& terms) {
  toml::table table;
  if (!terms.gravity.empty()) table.insert("gravity", terms.gravity);
  if (terms.inertia != 0) table.insert("inertia", terms.inertia);
  if (terms.hold) table.insert("hold", true);
  if (terms.horizon_s != 0) table.insert("horizon", terms.horizon_s);
  return table;
}

// What is known of one formula with one set of constants is not known of a shape.
std::string read_category(const TomlTable& table, const std::vector<std::string>& inputs) {
  std::string category;
  table.read("category", category);
  if (!table.has("category")) return category;
  if (category.empty()) {
    throw_bad_input("'category' is empty", table.place("category"),
                    "name the column, or leave 'category' out");
  }
  if (std::ranges::count(inputs, category) > 0) {
    throw_bad_input(fmt::format("'{}' is an input and the category", category),
                    table.place("category"), "leave it out of 'inputs'");
  }
  for (const char* key : {"law", "motion"}) {
    if (!table.has(key)) continue;
    throw_bad_input(
        fmt::format("'{}' is of one formula, and with 'category' there are several", key),
        table.place(key), "leave one of the two out");
  }
  return category;
}

UserProblem read_one(const TomlTable& table, const fs::path& folder) {
  UserProblem own;
  own.place = table.place();
  table.require("target");
  table.read("name", own.name);
  if (table.has("name")) require_plain_name(own.name, "a problem", table.place("name"));
  own.files = read_sources(table, folder);
  if (own.files.empty()) {
    throw_bad_input("the problem has no data", table.place(),
                    "give file, files, folder or glob, from the grid file's folder");
  }
  table.read("target", own.target);
  table.read("inputs", own.inputs);
  if (table.has("inputs") && own.inputs.empty()) {
    throw_bad_input(
        "the problem has no inputs", table.place("inputs"),
        "name columns, or leave the key out: then every other column of numbers is one");
  }
  own.reading = read_data_options(table);
  table.read("group", own.group);
  own.category = read_category(table, own.inputs);
  own.held_out = read_held_out(table.table("split", {"share", "seeds", "column", "values", "file",
                                                     "files", "folder", "glob", "sha256"}),
                               folder);
  own.passed_over = take_out_notes(own.files, own.target);
  if (own.held_out.kind == HeldOut::Kind::files) {
    for (fs::path& note : take_out_notes(own.held_out.files, own.target)) {
      own.passed_over.push_back(std::move(note));
    }
    leave_out_tests(own.files, own.held_out.files, table.place("split"));
  }
  table.read("law", own.law);
  own.units = read_units(table);
  own.box = read_box(table);
  own.motion = read_motion(table);
  return own;
}

// Without a name each file is a problem.
std::vector<UserProblem> named(UserProblem own) {
  if (!own.name.empty()) return {std::move(own)};
  std::vector<UserProblem> all;
  for (const DataSource& source : own.files) {
    UserProblem one = own;
    one.name = name_of_file(source.file);
    one.files = {source};
    all.push_back(std::move(one));
  }
  return all;
}

std::string file_text(const fs::path& file, FileNames names, const fs::path& folder) {
  if (names == FileNames::bare) return file.filename().string();
  if (names == FileNames::as_held) return file.string();
  return fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder)).string();
}

toml::array texts_array(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

void insert_sources(toml::table& table, std::span<const DataSource> sources, FileNames names,
                    const fs::path& folder) {
  toml::array files;
  toml::array hashes;
  for (const DataSource& source : sources) {
    files.push_back(file_text(source.file, names, folder));
    hashes.push_back(source.sha256);
  }
  table.insert("files", std::move(files));
  table.insert("sha256", std::move(hashes));
}

toml::table split_table(const HeldOut& held_out, FileNames names, const fs::path& folder) {
  toml::table table;
  if (held_out.kind == HeldOut::Kind::values) {
    table.insert("column", held_out.column);
    table.insert("values", texts_array(held_out.values));
  } else if (held_out.kind == HeldOut::Kind::files) {
    insert_sources(table, held_out.files, names, folder);
  } else {
    table.insert("share", held_out.share);
    toml::array seeds;
    for (const std::uint64_t seed : held_out.seeds) {
      seeds.push_back(static_cast<std::int64_t>(seed));
    }
    if (!seeds.empty()) table.insert("seeds", std::move(seeds));
  }
  return table;
}

toml::table problem_table(const UserProblem& own, FileNames names, const fs::path& folder) {
  toml::table table{{"name", own.name}, {"target", own.target}};
  insert_sources(table, own.files, names, folder);
  if (!own.inputs.empty()) table.insert("inputs", texts_array(own.inputs));
  insert_data_options(table, own.reading);
  if (!own.group.empty()) table.insert("group", own.group);
  if (!own.category.empty()) table.insert("category", own.category);
  table.insert("split", split_table(own.held_out, names, folder));
  if (!own.law.empty()) table.insert("law", own.law);
  toml::table units;
  for (const auto& [column, unit] : own.units) units.insert(column, unit);
  if (!units.empty()) table.insert("units", std::move(units));
  toml::table box;
  for (const auto& [input, range] : own.box) {
    box.insert(input, toml::array{range.first, range.second});
  }
  if (!box.empty()) table.insert("box", std::move(box));
  if (own.motion) table.insert("motion", motion_table(*own.motion));
  return table;
}

}  // namespace

std::vector<UserProblem> read_user_problems(const TomlTable& file, const fs::path& folder) {
  std::vector<UserProblem> all;
  std::set<std::string> seen;
  for (const TomlTable& table : file.array_of_tables("problem", problem_keys())) {
    for (UserProblem& own : named(read_one(table, folder))) {
      if (!seen.insert(own.name).second) {
        throw_bad_input(fmt::format("two problems are called '{}'", own.name), table.place(),
                        "give each a name of its own");
      }
      all.push_back(std::move(own));
    }
  }
  return all;
}

std::vector<UserProblem> parse_user_problems(std::string_view toml, const std::string& file_name,
                                             const fs::path& folder) {
  const toml::table root = parse_toml(toml, file_name);
  std::vector<std::string> keys;
  for (const auto& [key, node] : root) keys.emplace_back(key.str());
  return read_user_problems(TomlTable(root, file_name, "", keys), folder);
}

toml::array user_problems_array(std::span<const UserProblem> own, FileNames names,
                                const fs::path& folder) {
  toml::array array;
  for (const UserProblem& one : own) array.push_back(problem_table(one, names, folder));
  return array;
}

std::string print_user_problem(const UserProblem& own) {
  const toml::table root{{"problem", user_problems_array({&own, 1}, FileNames::as_held)}};
  std::ostringstream text;
  text << root << "\n";
  return text.str();
}

std::string moved_grid_text(std::string_view toml, const std::string& file_name,
                            const fs::path& from, const fs::path& to) {
  toml::table root = parse_toml(toml, file_name);
  if (!root.contains("problem")) return std::string(toml);
  const std::vector<UserProblem> own = parse_user_problems(toml, file_name, from);
  root.insert_or_assign("problem", user_problems_array(own, FileNames::from_folder, to));
  std::ostringstream text;
  text << root << "\n";
  return text.str();
}

}  // namespace tribench::user
