// SPDX-License-Identifier: MIT
//
// Effects as TOML, one [[effect]] table each: what --save-effect writes and --learned reads.
#include <fmt/format.h>

#include <toml++/toml.h>
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
  if (shape.grid.empty()) throw_bad_input("a shape has no grid", place, "give it grid = [1.0]");
  return shape;
}

EffectFamily read_effect(const toml::table& table, const std::string& place) {
  EffectFamily family;
  family.name = needed_text(table, "name", place);
  family.id = "learned";
  family.phrase = needed_text(table, "phrase", place);
  family.summary = table["summary"].value_or(family.phrase);
  family.source = table["source"].value_or(std::string("a file"));
  family.origin = table["origin"].value_or(std::string());
  family.angular = table["angular"].value_or(false);
  family.separate_by = texts(table, "separate_by");
  AtomTemplate atom;
  atom.columns = texts(table, "columns");
  if (atom.columns.empty()) throw_bad_input("an effect has no columns", place);
  for (const std::string& column : atom.columns) {
    std::vector<std::string> names;
    parse_collecting_names(column, names);  // throws where it is no formula
    atom.coefficients.push_back(fmt::format("c{}", atom.coefficients.size() + 1));
  }
  if (const toml::array* shapes = table["shape"].as_array()) {
    for (const toml::node& node : *shapes) {
      if (const toml::table* shape = node.as_table()) {
        atom.shapes.push_back(read_shape(*shape, place));
      }
    }
  }
  family.atoms = {std::move(atom)};
  return family;
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
  const toml::array* effects = table["effect"].as_array();
  if (effects == nullptr) {
    throw_bad_input("there is no [[effect]] in the file", file.string(),
                    "see --save-effect for the form");
  }
  std::vector<EffectFamily> all;
  for (const toml::node& node : *effects) {
    if (const toml::table* effect = node.as_table()) {
      all.push_back(read_effect(*effect, file.string()));
    }
  }
  return all;
}

std::string write_effects(std::span<const EffectFamily> effects) {
  toml::array array;
  for (const EffectFamily& family : effects) {
    for (const AtomTemplate& atom : family.atoms) {
      toml::table table{{"name", family.name},
                        {"phrase", family.phrase},
                        {"summary", family.summary},
                        {"source", family.source},
                        {"origin", family.origin}};
      toml::array columns;
      for (const std::string& column : atom.columns) columns.push_back(column);
      table.insert("columns", std::move(columns));
      toml::array separate;
      for (const std::string& rule : family.separate_by) separate.push_back(rule);
      table.insert("separate_by", std::move(separate));
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
      array.push_back(std::move(table));
    }
  }
  std::ostringstream out;
  out << toml::table{{"effect", std::move(array)}} << "\n";
  return out.str();
}

}  // namespace tribench::loop
