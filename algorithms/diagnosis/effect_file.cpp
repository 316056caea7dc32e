// SPDX-License-Identifier: MIT
//
// Effects as TOML: what --save-effect writes and --learned reads. A table [[effect]] is one atom of
// a family; tables of one name are its atoms, and what belongs to the family stands in the first.
#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <sstream>

#include "algorithms/diagnosis/effect_library.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

std::string needed_text(const toml::table& table, std::string_view key, const std::string& place) {
  const std::optional<std::string> value = table[key].value<std::string>();
  if (value) return *value;
  throw_bad_input(fmt::format("an effect lacks '{}'", key), place,
                  "give it name, phrase and columns");
}

std::vector<std::string> texts(const toml::table& table, std::string_view key) {
  std::vector<std::string> all;
  if (const toml::array* array = table[key].as_array()) {
    for (const toml::node& node : *array) all.push_back(node.value_or(std::string()));
  }
  return all;
}

toml::array array_of(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

// The tables of an array of tables; none where there is none.
std::vector<const toml::table*> tables(const toml::table& table, std::string_view key) {
  std::vector<const toml::table*> all;
  if (const toml::array* array = table[key].as_array()) {
    for (const toml::node& node : *array) {
      if (const toml::table* entry = node.as_table()) all.push_back(entry);
    }
  }
  return all;
}

ShapeTemplate read_shape(const toml::table& table, const std::string& place) {
  ShapeTemplate shape;
  shape.name = needed_text(table, "name", place);
  shape.scale = table["scale"].value_or(std::string());
  if (const toml::array* grid = table["grid"].as_array()) {
    for (const toml::node& node : *grid) shape.grid.push_back(node.value_or(0.0));
  }
  shape.low = table["low"].value_or(0.0);
  shape.high = table["high"].value_or(0.0);
  shape.recorded = table["recorded"].value_or(false);
  // N is the gear ratio: its grid comes with the data.
  if (shape.grid.empty() && shape.name != "N") {
    throw_bad_input(fmt::format("the shape '{}' has no grid", shape.name), place,
                    "give it grid = [1.0]");
  }
  return shape;
}

AtomTemplate read_atom(const toml::table& table, const std::string& place) {
  AtomTemplate atom;
  atom.columns = texts(table, "columns");
  if (atom.columns.empty()) {
    throw_bad_input("an effect has no columns", place, "give it columns = [\"sgn_v*abs(g)\"]");
  }
  for (const std::string& column : atom.columns) {
    std::vector<std::string> names;
    parse_collecting_names(column, names);  // throws where it is no formula
  }
  atom.coefficients = texts(table, "coefficients");
  if (!atom.coefficients.empty() && atom.coefficients.size() != atom.columns.size()) {
    throw_bad_input("an effect has not as many coefficients as columns", place,
                    "name one for each column");
  }
  for (std::size_t k = atom.coefficients.size(); k < atom.columns.size(); ++k) {
    atom.coefficients.push_back(fmt::format("c{}", k + 1));
  }
  for (const toml::table* shape : tables(table, "shape")) {
    atom.shapes.push_back(read_shape(*shape, place));
  }
  atom.rigid_load = table["rigid_load"].value_or(false);
  return atom;
}

EffectFamily read_family(const toml::table& table, const std::string& place) {
  EffectFamily family;
  family.name = needed_text(table, "name", place);
  family.id = table["id"].value_or(std::string("learned"));
  family.phrase = needed_text(table, "phrase", place);
  family.summary = table["summary"].value_or(family.phrase);
  family.source = table["source"].value_or(std::string("a file"));
  family.origin = table["origin"].value_or(std::string());
  family.angular = table["angular"].value_or(false);
  family.separate_by = texts(table, "separate_by");
  for (const toml::table* one : tables(table, "sanity")) {
    family.sanity.push_back({needed_text(*one, "coefficient", place), (*one)["sign"].value_or(0),
                             (*one)["largest"].value_or(0.0), (*one)["excused_nats"].value_or(1e30),
                             (*one)["why"].value_or(std::string("not physical"))});
  }
  for (const toml::table* one : tables(table, "alias")) {
    family.known_aliases.push_back({needed_text(*one, "name", place),
                                    (*one)["separate_by"].value_or(std::string()),
                                    (*one)["coefficient"].value_or(std::string())});
  }
  return family;
}

// What belongs to the family and not to one of its atoms.
void insert_family(toml::table& table, const EffectFamily& family) {
  table.insert("id", family.id);
  table.insert("phrase", family.phrase);
  table.insert("summary", family.summary);
  table.insert("source", family.source);
  table.insert("origin", family.origin);
  table.insert("angular", family.angular);
  table.insert("separate_by", array_of(family.separate_by));
  toml::array sanity;
  for (const Sanity& one : family.sanity) {
    sanity.push_back(toml::table{{"coefficient", one.coefficient},
                                 {"sign", one.sign},
                                 {"largest", one.largest},
                                 {"excused_nats", one.excused_nats},
                                 {"why", one.why}});
  }
  if (!sanity.empty()) table.insert("sanity", std::move(sanity));
  toml::array aliases;
  for (const KnownAlias& one : family.known_aliases) {
    aliases.push_back(toml::table{
        {"name", one.name}, {"separate_by", one.separate_by}, {"coefficient", one.coefficient}});
  }
  if (!aliases.empty()) table.insert("alias", std::move(aliases));
}

toml::table table_of(const AtomTemplate& atom) {
  toml::table table{{"columns", array_of(atom.columns)},
                    {"coefficients", array_of(atom.coefficients)}};
  if (atom.rigid_load) table.insert("rigid_load", true);
  toml::array shapes;
  for (const ShapeTemplate& shape : atom.shapes) {
    toml::array grid;
    for (const double value : shape.grid) grid.push_back(value);
    shapes.push_back(toml::table{{"name", shape.name},
                                 {"scale", shape.scale},
                                 {"grid", std::move(grid)},
                                 {"low", shape.low},
                                 {"high", shape.high},
                                 {"recorded", shape.recorded}});
  }
  if (!shapes.empty()) table.insert("shape", std::move(shapes));
  return table;
}

}  // namespace

std::vector<EffectFamily> read_effects(const std::filesystem::path& file) {
  toml::table table;
  try {
    table = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    throw_bad_input(std::string(error.description()),
                    fmt::format("{}:{}", file.string(), error.source().begin.line),
                    "see --save-effect for the form");
  }
  if (table["effect"].as_array() == nullptr) {
    throw_bad_input("there is no [[effect]] in the file", file.string(),
                    "see --save-effect for the form");
  }
  std::vector<EffectFamily> all;
  for (const toml::table* effect : tables(table, "effect")) {
    const std::string place = fmt::format("{}:{}", file.string(), effect->source().begin.line);
    const std::string name = needed_text(*effect, "name", place);
    auto family = std::ranges::find(all, name, &EffectFamily::name);
    if (family == all.end()) family = all.insert(all.end(), read_family(*effect, place));
    family->atoms.push_back(read_atom(*effect, place));
  }
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
