// SPDX-License-Identifier: MIT
//
// Effects as TOML: what --save-effect writes and --learned reads. A table [[effect]] is one atom of
// a family; tables of one name are its atoms, and what belongs to the family stands in the first.
#include <fmt/format.h>

#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <type_traits>

#include "algorithms/effects/effect_checks.hpp"
#include "algorithms/effects/effect_library.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"
#include "foundation/toml_table.hpp"

namespace tribench::loop {
namespace {

// A file of these sizes holds any library that a person or a method writes; beyond them the tests
// would have nothing left to find an effect with, and the memory would go first.
constexpr std::uintmax_t kMostBytes = 1'000'000;
constexpr std::size_t kMostColumns = 2000;  // of the file, every shape of the grids counted

// Of an [[effect]]: what the first table of a name says of the family, and what each says.
const std::vector<std::string> kFamilyKeys = {"id",     "phrase", "summary",    "source",
                                              "origin", "title",  "angular",    "changeable",
                                              "sanity", "alias",  "separate_by"};
const std::vector<std::string> kAtomKeys = {
    "name",           "columns",      "coefficients", "shape",       "curve",
    "beside_another", "by_direction", "one_way",      "last_resort", "without_inertia"};

// A table of the file, its keys checked against what may stand there. Every error names the line.
class Entry {
 public:
  Entry(const toml::table& table, const std::string& file, std::vector<std::string> known)
      : table_(table), file_(file), known_(std::move(known)) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::ranges::count(known_, name) > 0) continue;
      throw_bad_input(fmt::format("an effect has no '{}'", name), place(node),
                      did_you_mean(name, known_));
    }
  }

  std::string place() const { return place(table_); }

  template <typename T>
  std::optional<T> find(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node == nullptr ? std::nullopt : std::optional<T>(value<T>(*node, key));
  }

  std::string needed_text(std::string_view key) const {
    const std::optional<std::string> text = find<std::string>(key);
    if (text && !text->empty()) return *text;
    throw_bad_input(fmt::format("an effect lacks '{}'", key), place(),
                    "give it name, phrase and columns");
  }

  template <typename T>
  std::vector<T> list(std::string_view key) const {
    std::vector<T> all;
    for (const toml::node* node : elements(key)) all.push_back(value<T>(*node, key));
    return all;
  }

  void refuse_any(const std::vector<std::string>& keys, const std::string& mend) const {
    for (const std::string& key : keys) {
      const toml::node* node = table_.get(key);
      if (node == nullptr) continue;
      throw_bad_input(fmt::format("a further table of an effect has '{}'", key), place(*node),
                      mend);
    }
  }

  // The tables of an array of tables; none where there is none.
  std::vector<Entry> entries(std::string_view key, const std::vector<std::string>& known) const {
    std::vector<Entry> all;
    for (const toml::node* node : elements(key)) {
      if (!node->is_table()) refuse(*node, key, "a list of tables");
      all.emplace_back(*node->as_table(), file_, known);
    }
    return all;
  }

 private:
  std::string place(const toml::node& node) const {
    return fmt::format("{}:{}", file_, node.source().begin.line);
  }

  [[noreturn]] void refuse(const toml::node& node, std::string_view key,
                           std::string_view wanted) const {
    throw_bad_input(fmt::format("'{}' is no {}", key, wanted), place(node),
                    fmt::format("give {} = {}", key, wanted));
  }

  std::vector<const toml::node*> elements(std::string_view key) const {
    std::vector<const toml::node*> all;
    const toml::node* node = table_.get(key);
    if (node == nullptr) return all;
    if (!node->is_array()) refuse(*node, key, "list");
    for (const toml::node& element : *node->as_array()) all.push_back(&element);
    return all;
  }

  template <typename T>
  T value(const toml::node& node, std::string_view key) const {
    if constexpr (std::is_same_v<T, std::string>) {
      if (!node.is_string()) refuse(node, key, "text");
      if (holds_control_characters(node.as_string()->get())) refuse(node, key, "one line of text");
      return node.as_string()->get();
    } else if constexpr (std::is_same_v<T, bool>) {
      if (!node.is_boolean()) refuse(node, key, "true or false");
      return node.as_boolean()->get();
    } else {
      const std::optional<double> number =
          node.is_number() ? node.value<double>() : std::optional<double>();
      if (!number || !std::isfinite(*number)) refuse(node, key, "finite number");
      return *number;
    }
  }

  const toml::table& table_;
  std::string file_;
  std::vector<std::string> known_;
};

toml::array array_of(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

ShapeTemplate read_shape(const Entry& entry) {
  ShapeTemplate shape;
  shape.name = entry.needed_text("name");
  shape.scale = entry.find<std::string>("scale").value_or("");
  shape.grid = entry.list<double>("grid");
  shape.low = entry.find<double>("low").value_or(0);
  shape.high = entry.find<double>("high").value_or(0);
  shape.recorded = entry.find<bool>("recorded").value_or(false);
  shape.reference = entry.find<bool>("reference").value_or(false);
  const bool is_gear_ratio = entry.find<bool>("gear_ratio").value_or(false);
  const bool plain = shape.grid.empty() && shape.scale.empty() && shape.low == 0 &&
                     shape.high == 0 && !shape.recorded && !shape.reference;
  if (is_gear_ratio && !plain) {
    throw_bad_input(
        fmt::format("the shape '{}' is the gear ratio and takes nothing else", shape.name),
        entry.place(), "leave out gear_ratio, or all but name and gear_ratio");
  }
  if (is_gear_ratio) shape.values = ShapeValues::gear_ratios;
  if (!is_gear_ratio && shape.grid.empty()) {
    throw_bad_input(fmt::format("the shape '{}' has no grid", shape.name), entry.place(),
                    "give it grid = [1.0], or gear_ratio = true");
  }
  if (shape.high < shape.low) {
    throw_bad_input(fmt::format("the shape '{}' has low = {} above high = {}", shape.name,
                                shape.low, shape.high),
                    entry.place(), "turn them round; low = high: the shape stays on its grid");
  }
  return shape;
}

constexpr std::array kCurves = {SpeedCurve::any, SpeedCurve::falls, SpeedCurve::rises};

std::string_view curve_name(SpeedCurve curve) {
  if (curve == SpeedCurve::any) return "any";
  return curve == SpeedCurve::falls ? "falls" : "rises";
}

SpeedCurve read_curve(const Entry& entry) {
  const std::string text = entry.find<std::string>("curve").value_or("any");
  const auto* found = std::ranges::find(kCurves, text, curve_name);
  if (found != kCurves.end()) return *found;
  throw_bad_input(fmt::format("'curve' is '{}'", text), entry.place(), "give any, falls or rises");
}

AtomTemplate read_atom(const Entry& entry) {
  AtomTemplate atom;
  atom.columns = entry.list<std::string>("columns");
  for (const Entry& shape : entry.entries("shape", {"name", "scale", "grid", "low", "high",
                                                    "recorded", "reference", "gear_ratio"})) {
    atom.shapes.push_back(read_shape(shape));
  }
  atom.coefficients = entry.list<std::string>("coefficients");
  if (!atom.coefficients.empty() && atom.coefficients.size() != atom.columns.size()) {
    throw_bad_input("an effect has not as many coefficients as columns", entry.place(),
                    "name one for each column");
  }
  for (std::size_t k = atom.coefficients.size(); k < atom.columns.size(); ++k) {
    atom.coefficients.push_back(fmt::format("c{}", k + 1));
  }
  atom.beside_another = entry.find<bool>("beside_another").value_or(false);
  atom.by_direction = entry.find<bool>("by_direction").value_or(false);
  atom.one_way = entry.find<bool>("one_way").value_or(false);
  atom.last_resort = entry.find<bool>("last_resort").value_or(false);
  atom.without_inertia = entry.find<bool>("without_inertia").value_or(false);
  atom.curve = read_curve(entry);
  check_atom(atom, entry.place());
  return atom;
}

Sanity read_sanity(const Entry& entry) {
  Sanity sanity;
  sanity.coefficient = entry.needed_text("coefficient");
  const double sign = entry.find<double>("sign").value_or(0);
  if (sign != 0 && std::abs(sign) != 1) {
    throw_bad_input(fmt::format("'sign' is {}", sign), entry.place(), "give 1, -1 or 0 (any)");
  }
  sanity.sign = static_cast<int>(sign);
  sanity.largest = entry.find<double>("largest").value_or(0);
  if (sanity.largest < 0) {
    throw_bad_input(fmt::format("'largest' is {}", sanity.largest), entry.place(),
                    "give a magnitude, or 0 (any)");
  }
  sanity.why = entry.find<std::string>("why").value_or("not physical");
  return sanity;
}

EffectFamily read_family(const Entry& entry) {
  EffectFamily family;
  family.name = entry.needed_text("name");
  family.id = entry.find<std::string>("id").value_or("learned");
  family.phrase = entry.needed_text("phrase");
  family.summary = entry.find<std::string>("summary").value_or(family.phrase);
  family.source = entry.find<std::string>("source").value_or("a file");
  family.origin = entry.find<std::string>("origin").value_or("");
  family.title = entry.find<std::string>("title").value_or("");
  family.angular = entry.find<bool>("angular").value_or(false);
  family.changeable = entry.find<bool>("changeable").value_or(false);
  family.separate_by = entry.list<std::string>("separate_by");
  for (const Entry& one : entry.entries("sanity", {"coefficient", "sign", "largest", "why"})) {
    family.sanity.push_back(read_sanity(one));
  }
  for (const Entry& one :
       entry.entries("alias", {"name", "separate_by", "coefficient", "unless_known"})) {
    family.known_aliases.push_back({one.needed_text("name"),
                                    one.find<std::string>("separate_by").value_or(""),
                                    one.find<std::string>("coefficient").value_or(""),
                                    one.find<std::string>("unless_known").value_or("")});
  }
  return family;
}

// How many columns the atom's grids make of it; a gear ratio counts as one.
std::size_t columns_made(const AtomTemplate& atom) {
  std::size_t count = atom.columns.size();
  for (const ShapeTemplate& shape : atom.shapes) {
    count *= std::clamp<std::size_t>(shape.grid.size(), 1, kMostColumns + 1);
    count = std::min(count, kMostColumns + 1);
  }
  return count;
}

toml::table parse_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > kMostBytes) {
    throw_bad_input(fmt::format("the file has {} bytes, more than {}", bytes, kMostBytes),
                    file.string(), "an effect takes a few lines; see --save-effect for the form");
  }
  return parse_toml(read_file(file), file.string());
}

// What belongs to the family and not to one of its atoms.
void insert_family(toml::table& table, const EffectFamily& family) {
  table.insert("id", family.id);
  table.insert("phrase", family.phrase);
  table.insert("summary", family.summary);
  table.insert("source", family.source);
  table.insert("origin", family.origin);
  if (!family.title.empty()) table.insert("title", family.title);
  table.insert("angular", family.angular);
  if (family.changeable) table.insert("changeable", true);
  table.insert("separate_by", array_of(family.separate_by));
  toml::array sanity;
  for (const Sanity& one : family.sanity) {
    sanity.push_back(toml::table{{"coefficient", one.coefficient},
                                 {"sign", one.sign},
                                 {"largest", one.largest},
                                 {"why", one.why}});
  }
  if (!sanity.empty()) table.insert("sanity", std::move(sanity));
  toml::array aliases;
  for (const KnownAlias& one : family.known_aliases) {
    aliases.push_back(toml::table{{"name", one.name},
                                  {"separate_by", one.separate_by},
                                  {"coefficient", one.coefficient},
                                  {"unless_known", one.unless_known}});
  }
  if (!aliases.empty()) table.insert("alias", std::move(aliases));
}

toml::table table_of(const AtomTemplate& atom) {
  toml::table table{{"columns", array_of(atom.columns)},
                    {"coefficients", array_of(atom.coefficients)}};
  if (atom.beside_another) table.insert("beside_another", true);
  if (atom.by_direction) table.insert("by_direction", true);
  if (atom.one_way) table.insert("one_way", true);
  if (atom.last_resort) table.insert("last_resort", true);
  if (atom.without_inertia) table.insert("without_inertia", true);
  if (atom.curve != SpeedCurve::any) table.insert("curve", std::string(curve_name(atom.curve)));
  toml::array shapes;
  for (const ShapeTemplate& shape : atom.shapes) {
    if (shape.values == ShapeValues::gear_ratios) {
      shapes.push_back(toml::table{{"name", shape.name}, {"gear_ratio", true}});
      continue;
    }
    toml::array grid;
    for (const double value : shape.grid) grid.push_back(value);
    shapes.push_back(toml::table{{"name", shape.name},
                                 {"scale", shape.scale},
                                 {"grid", std::move(grid)},
                                 {"low", shape.low},
                                 {"high", shape.high},
                                 {"recorded", shape.recorded},
                                 {"reference", shape.reference}});
  }
  if (!shapes.empty()) table.insert("shape", std::move(shapes));
  return table;
}

}  // namespace

std::vector<EffectFamily> read_effects(const std::filesystem::path& file) {
  const toml::table table = parse_file(file);
  const Entry whole(table, file.string(), {"effect"});
  std::vector<std::string> keys = kFamilyKeys;
  keys.insert(keys.end(), kAtomKeys.begin(), kAtomKeys.end());
  const std::vector<Entry> effects = whole.entries("effect", keys);
  if (effects.empty()) {
    throw_bad_input("there is no [[effect]] in the file", file.string(),
                    "see --save-effect for the form");
  }
  std::vector<EffectFamily> all;
  std::vector<std::string> places;  // of each family
  std::size_t columns = 0;
  for (const Entry& effect : effects) {
    const std::string name = effect.needed_text("name");
    auto family = std::ranges::find(all, name, &EffectFamily::name);
    if (family == all.end()) {
      family = all.insert(all.end(), read_family(effect));
      places.push_back(effect.place());
    } else {
      effect.refuse_any(kFamilyKeys, fmt::format("it belongs into the first table of '{}'", name));
    }
    family->atoms.push_back(read_atom(effect));
    columns += columns_made(family->atoms.back());
    if (columns <= kMostColumns) continue;
    throw_bad_input(fmt::format("the grids make more than {} columns", kMostColumns),
                    effect.place(), "a few values a shape will do: they are refined");
  }
  for (std::size_t f = 0; f < all.size(); ++f) check_family(all[f], places[f]);
  return all;
}

std::string write_effects(std::span<const EffectFamily> effects) {
  toml::array array;
  for (const EffectFamily& family : effects) {
    for (std::size_t k = 0; k < family.atoms.size(); ++k) {
      toml::table table = table_of(family.atoms[k]);
      table.insert("name", family.name);
      if (k == 0) insert_family(table, family);
      array.push_back(std::move(table));
    }
  }
  std::ostringstream out;
  out << toml::table{{"effect", std::move(array)}} << "\n";
  return out.str();
}

}  // namespace tribench::loop
