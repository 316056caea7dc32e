// SPDX-License-Identifier: MIT
#include "problems/measured/manifest.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <set>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "foundation/toml_table.hpp"

namespace tribench::embedded {
std::string_view manifest_bam_xl330();
std::string_view manifest_emps();
std::string_view manifest_kinova_gen3();
std::string_view manifest_screw_drives();
std::string_view manifest_ur10e_dynamic();
std::string_view manifest_ur10e_jointwise();
}  // namespace tribench::embedded

namespace tribench::measured {
namespace {

// A TOML table that knows where it stands and which of its keys were asked for.
class Reader {
 public:
  Reader(const toml::table& table, std::string_view file) : table_(table), file_(file) {}

  std::string place(const toml::node& node) const {
    return fmt::format("{}:{}", file_, node.source().begin.line);
  }
  std::string place() const { return place(table_); }

  const toml::node* find(std::string_view key) {
    known_.emplace_back(key);
    return table_.get(key);
  }

  template <typename T>
  T value(std::string_view key, T fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    const auto given = node->value<T>();
    if (!given) throw_bad_input(fmt::format("'{}' has the wrong type", key), place(*node));
    return *given;
  }
  std::string text(std::string_view key) {
    const std::string given = value<std::string>(key, "");
    if (given.empty()) throw_bad_input(fmt::format("'{}' is missing", key), place());
    return given;
  }
  std::vector<std::string> texts(std::string_view key) {
    std::vector<std::string> all;
    const toml::node* node = find(key);
    if (node == nullptr) return all;
    if (const auto one = node->value<std::string>()) return {*one};
    if (!node->is_array()) throw_bad_input(fmt::format("'{}' is no list", key), place(*node));
    for (const toml::node& item : *node->as_array()) {
      const auto given = item.value<std::string>();
      if (!given) throw_bad_input(fmt::format("'{}' holds no text", key), place(item));
      all.push_back(*given);
    }
    return all;
  }
  std::vector<Reader> tables(std::string_view key) {
    std::vector<Reader> all;
    const toml::node* node = find(key);
    if (node == nullptr) return all;
    if (!node->is_array())
      throw_bad_input(fmt::format("'{}' is no [[{}]]", key, key), place(*node));
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_table()) throw_bad_input(fmt::format("'{}' is no table", key), place(item));
      all.emplace_back(*item.as_table(), file_);
    }
    return all;
  }
  std::optional<Reader> table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) throw_bad_input(fmt::format("'{}' is no table", key), place(*node));
    return Reader(*node->as_table(), file_);
  }
  std::vector<std::string> keys() const {
    std::vector<std::string> all;
    for (const auto& [key, node] : table_) all.emplace_back(key.str());
    return all;
  }

  // Every key of the table must have been asked for.
  void refuse_unknown() const {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      throw_bad_input(fmt::format("unknown key '{}'", name), place(node),
                      did_you_mean(name, known_));
    }
  }

 private:
  const toml::table& table_;
  std::string file_;
  std::vector<std::string> known_;
};

using Columns = std::map<std::string, ColumnMeaning, std::less<>>;

void read_columns(Reader& owner, Columns& columns) {
  std::optional<Reader> table = owner.table("columns");
  if (!table) return;
  for (const std::string& column : table->keys()) {
    Reader meaning = *table->table(column);
    ColumnMeaning read;
    read.role = find_role(meaning.value<std::string>("role", "none"));
    if (meaning.find("unit") != nullptr) read.unit = meaning.text("unit");
    meaning.refuse_unknown();
    columns[column] = read;
  }
}

DerivedChannel read_derived(Reader& table) {
  DerivedChannel derived;
  derived.name = table.text("name");
  derived.role = find_role(table.value<std::string>("role", "none"));
  derived.unit = table.value<std::string>("unit", "-");
  derived.factor = table.value("factor", 1.0);
  const std::vector<std::string> sign = table.texts("sign_of");
  const std::vector<std::string> difference = table.texts("difference");
  const std::vector<std::string> scaled = table.texts("scaled");
  table.refuse_unknown();
  if (sign.size() == 1 && difference.empty() && scaled.empty()) {
    derived.kind = DerivedChannel::Kind::sign;
    derived.of = sign;
  } else if (difference.size() == 2 && sign.empty() && scaled.empty()) {
    derived.kind = DerivedChannel::Kind::difference;
    derived.of = difference;
  } else if (scaled.size() == 1 && sign.empty() && difference.empty()) {
    derived.kind = DerivedChannel::Kind::scaled;
    derived.of = scaled;
  } else {
    throw_bad_input(fmt::format("channel '{}' is derived from nothing known", derived.name),
                    table.place(),
                    "give sign_of = \"X\", difference = [\"X\", \"Y\"] or scaled = \"X\"");
  }
  return derived;
}

MovementRule read_movements(Reader& problem) {
  MovementRule rule;
  std::optional<Reader> table = problem.table("movements");
  if (!table) return rule;
  rule.column = table->value<std::string>("column", "");
  const bool reversals = table->value("reversals", false);
  rule.pieces = static_cast<int>(table->value<std::int64_t>("pieces", 1));
  table->refuse_unknown();
  if (reversals) rule.kind = MovementRule::Kind::reversals;
  if (!rule.column.empty()) rule.kind = MovementRule::Kind::column;
  if ((reversals && !rule.column.empty()) || rule.pieces < 1) {
    throw_bad_input("movements are cut by a column or by reversals, into at least one piece",
                    table->place());
  }
  return rule;
}

void read_settings(Reader& table, ProblemPlan& plan) {
  plan.load = table.value("load", false);
  plan.decimate = static_cast<int>(table.value<std::int64_t>("decimate", 1));
  plan.average = table.value("average", false);
  plan.rows_per_movement =
      static_cast<std::size_t>(table.value<std::int64_t>("rows_per_movement", 0));
  plan.test_share = table.value("test_share", 0.2);
  if (std::optional<Reader> keep = table.table("keep")) {
    plan.keep_column = keep->text("column");
    plan.keep_value = keep->value("value", 0.0);
    keep->refuse_unknown();
  }
  if (std::optional<Reader> published = table.table("published_percent")) {
    for (const std::string& model : published->keys()) {
      plan.published_percent[model] = published->value(model, 0.0);
    }
  }
  if (plan.decimate < 1 || plan.test_share <= 0 || plan.test_share >= 1) {
    throw_bad_input("decimate is at least 1 and test_share between 0 and 1", table.place());
  }
}

// motion = {gravity = "5*sin(q)", hold = true, horizon = 0.5, inertia = 1.2}; an empty table
// declares that the formula holds all of it.
std::optional<MotionTerms> read_motion(Reader& problem) {
  std::optional<Reader> table = problem.table("motion");
  if (!table) return std::nullopt;
  MotionTerms terms;
  terms.gravity = table->value<std::string>("gravity", "");
  terms.inertia = table->value("inertia", 0.0);
  terms.hold = table->value("hold", false);
  terms.horizon_s = table->value("horizon", 0.0);
  table->refuse_unknown();
  if (terms.inertia < 0 || terms.horizon_s < 0) {
    throw_bad_input("inertia and horizon are not negative", table->place());
  }
  return terms;
}

std::string for_joint(std::string text, int joint) {
  constexpr std::string_view kPlaceholder = "{joint}";
  for (std::size_t at = text.find(kPlaceholder); at != std::string::npos;
       at = text.find(kPlaceholder)) {
    text.replace(at, kPlaceholder.size(), fmt::format("{}", joint));
  }
  return text;
}

ProblemPlan for_joint(ProblemPlan plan, int joint) {
  plan.joint = joint;
  for (std::string* text : {&plan.name, &plan.summary, &plan.file, &plan.test_file}) {
    *text = for_joint(std::move(*text), joint);
  }
  return plan;
}

std::vector<ProblemPlan> read_problem(Reader& table, const Columns& columns) {
  ProblemPlan plan;
  plan.name = table.text("name");
  plan.summary = table.text("summary");
  plan.file = table.text("file");
  plan.test_file = table.value<std::string>("test_file", "");
  plan.target = table.text("target");
  plan.inputs = table.texts("inputs");
  plan.columns = columns;
  read_columns(table, plan.columns);
  for (Reader& derived : table.tables("derived")) plan.derived.push_back(read_derived(derived));
  plan.movements = read_movements(table);
  plan.motion = read_motion(table);
  read_settings(table, plan);
  std::vector<ProblemPlan> plans;
  if (const toml::node* joints = table.find("joints")) {
    if (!joints->is_array()) throw_bad_input("'joints' is no list", table.place(*joints));
    for (const toml::node& joint : *joints->as_array()) {
      plans.push_back(for_joint(plan, static_cast<int>(joint.value_or<std::int64_t>(0))));
    }
  } else {
    plans.push_back(std::move(plan));
  }
  table.refuse_unknown();
  return plans;
}

}  // namespace

Manifest parse_manifest(std::string_view text, std::string_view file) {
  const toml::table root = parse_toml(text, file);
  Reader reader(root, file);
  Manifest manifest;
  manifest.name = reader.text("name");
  manifest.title = reader.text("title");
  manifest.source = reader.text("source");
  manifest.licence = reader.text("licence");
  manifest.cite = reader.value<std::string>("cite", "");
  for (Reader& item : reader.tables("file")) {
    File entry;
    entry.name = item.text("name");
    entry.sha256 = item.text("sha256");
    entry.rows = static_cast<std::size_t>(item.value<std::int64_t>("rows", 0));
    item.refuse_unknown();
    manifest.files.push_back(std::move(entry));
  }
  Columns columns;
  read_columns(reader, columns);
  for (Reader& item : reader.tables("problem")) {
    for (ProblemPlan& plan : read_problem(item, columns)) {
      manifest.problems.push_back(std::move(plan));
    }
  }
  reader.refuse_unknown();
  return manifest;
}

const std::vector<Manifest>& shipped_manifests() {
  static const std::vector<Manifest> kManifests = {
      parse_manifest(embedded::manifest_bam_xl330(), "bam-xl330.toml"),
      parse_manifest(embedded::manifest_emps(), "emps.toml"),
      parse_manifest(embedded::manifest_kinova_gen3(), "kinova-gen3.toml"),
      parse_manifest(embedded::manifest_screw_drives(), "screw-drives.toml"),
      parse_manifest(embedded::manifest_ur10e_dynamic(), "ur10e-dynamic.toml"),
      parse_manifest(embedded::manifest_ur10e_jointwise(), "ur10e-jointwise.toml")};
  return kManifests;
}

namespace {

// Names stand in cells' keys and in commands.
void require_names(const Manifest& manifest, const std::filesystem::path& file) {
  require_plain_name(manifest.name, "a measured set", file.string());
  if (manifest.name != file.parent_path().filename()) {
    throw_bad_input(fmt::format("the set is called '{}' and its folder '{}'", manifest.name,
                                file.parent_path().filename().string()),
                    file.string(), "call them alike");
  }
  for (const ProblemPlan& plan : manifest.problems) {
    for (const std::string& part : split(plan.name, '/')) {
      require_plain_name(part, "each part of a problem's name", file.string());
    }
  }
}

std::vector<std::filesystem::path> manifest_files(
    const std::optional<std::filesystem::path>& data) {
  std::vector<std::filesystem::path> files;
  std::error_code code;
  if (!data || !std::filesystem::is_directory(*data, code)) return files;
  for (const auto& folder : std::filesystem::directory_iterator(*data)) {
    std::filesystem::path file = folder.path() / "manifest.toml";
    if (std::filesystem::is_regular_file(file, code)) files.push_back(std::move(file));
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<Manifest> known_manifests(const std::optional<std::filesystem::path>& data) {
  std::vector<Manifest> known = shipped_manifests();
  for (const std::filesystem::path& file : manifest_files(data)) {
    Manifest own = parse_manifest(read_file(file), file.string());
    require_names(own, file);
    const auto same = std::ranges::find(known, own.name, &Manifest::name);
    if (same == known.end()) {
      known.push_back(std::move(own));
    } else {
      *same = std::move(own);
    }
  }
  std::set<std::string> seen;
  for (const Manifest& manifest : known) {
    for (const ProblemPlan& plan : manifest.problems) {
      if (seen.insert(plan.name).second) continue;
      throw_bad_input(fmt::format("two problems are called '{}'", plan.name), manifest.name,
                      "give one of them another name");
    }
  }
  return known;
}

const Manifest& find_manifest(const std::vector<Manifest>& known, std::string_view name) {
  std::vector<std::string> names;
  for (const Manifest& manifest : known) {
    if (manifest.name == name) return manifest;
    names.push_back(manifest.name);
  }
  throw_bad_input(fmt::format("there is no measured set '{}'", name), {},
                  did_you_mean(name, names));
}

}  // namespace tribench::measured
