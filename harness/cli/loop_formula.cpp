// SPDX-License-Identifier: MIT
#include "harness/cli/loop_formula.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/text.hpp"
#include "harness/loop/controller_code.hpp"

namespace tribench {
namespace {

// Of the names that the formula reads; none where one of them has no range.
std::optional<NamedBox> box_of(const loop::NamedFormula& read, const NamedBox& known) {
  NamedBox box;
  for (std::size_t j = 0; j < read.names.size(); ++j) {
    const bool is_read = std::ranges::any_of(read.formula.nodes(), [&](const Node& node) {
      return node.is_variable() && node.variable == j;
    });
    if (!is_read) continue;
    std::string name = read.names[j];
    if (name.starts_with("sgn_")) name = name.substr(4);
    if (std::ranges::count(box.names, name) > 0) continue;
    const auto found = std::ranges::find(known.names, name);
    if (found == known.names.end()) return std::nullopt;
    box.names.push_back(name);
    box.ranges.push_back(known.ranges[static_cast<std::size_t>(found - known.names.begin())]);
  }
  if (box.names.empty()) return std::nullopt;
  return box;
}

LoopFormula loop_formula_in(const nlohmann::json& json, std::span<const std::string> stay) {
  LoopFormula loop;
  NamedBox known;
  std::map<std::string, std::string> formulas;
  bool has_position = false;
  bool derives_distance = false;
  for (const nlohmann::json& symbol : json.at("symbols")) {
    const std::string name = symbol.value("name", "");
    has_position = has_position || name == "q";
    derives_distance =
        derives_distance || (loop::is_distance(name) && symbol.contains("computed_as"));
    const auto low = symbol.find("low");
    const auto high = symbol.find("high");
    if (low != symbol.end() && low->is_number() && high != symbol.end() && high->is_number()) {
      known.names.push_back(name);
      known.ranges.push_back({low->get<double>(), high->get<double>()});
    }
    const std::string formula = symbol.value("formula", "");
    if (formula.empty()) continue;
    if (name == "g") loop.gravity = formula;
    if (std::ranges::count(stay, name) == 0) formulas.emplace(name, formula);
  }
  if (derives_distance) {
    loop.distance_from = has_position ? loop::PathFrom::position : loop::PathFrom::velocity;
  }
  std::vector<std::string> names;
  const Expression formula = parse_collecting_names(json.at("formula").get<std::string>(), names);
  const loop::NamedFormula read = loop::with_formulas(formula, names, formulas);
  if (const auto target = json.find("target"); target != json.end()) {
    loop.unit = target->value("unit", "");
  }
  loop.text = print(read.formula, read.names);
  loop.box = box_of(read, known);
  return loop;
}

}  // namespace

LoopFormula read_loop_formula(const std::string& file, std::span<const std::string> stay) {
  std::string reason;
  const auto json = read_json<nlohmann::json>(read_file(file), &reason);
  if (json.is_discarded()) {
    throw_bad_input("this is no loop.json: " + reason, file,
                    "give a formula, or the loop.json that 'tribench loop --out' writes");
  }
  return loop_formula_of(json, file, stay);
}

LoopFormula loop_formula_of(const nlohmann::json& json, const std::string& file,
                            std::span<const std::string> stay) {
  try {
    return loop_formula_in(json, stay);
  } catch (const nlohmann::json::exception&) {  // no JSON, no object, another type
    throw_bad_input("this is no loop.json: it has no formula and symbols", file,
                    "give a formula, or the loop.json that 'tribench loop --out' writes");
  }
}

}  // namespace tribench
