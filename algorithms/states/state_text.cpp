// SPDX-License-Identifier: MIT
#include "algorithms/states/state_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/number_text.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

constexpr std::string_view kExample =
    "write NAME = LAW(input, parameter=number, ...); and then the formula";

std::optional<std::size_t> place_of(std::span<const std::string> names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

// One declaration, cut into its words.
struct Words {
  std::string name;
  std::string law;
  std::vector<std::string> arguments;
};

Words words_of_law(std::string_view name, std::string_view text) {
  text = trimmed(text);
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || !text.ends_with(')')) {
    throw_bad_input(fmt::format("'{}' is no law with its inputs and parameters", text),
                    fmt::format("state '{}'", name), kExample);
  }
  Words words{std::string(name), std::string(trimmed(text.substr(0, open))), {}};
  for (const std::string& part : split(text.substr(open + 1, text.size() - open - 2), ',')) {
    words.arguments.emplace_back(trimmed(part));
  }
  return words;
}

Words words_of_declaration(std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::size_t open = text.find('(');
  if (equals == std::string_view::npos || equals > open) {
    throw_bad_input(fmt::format("'{}' declares no state", trimmed(text)), "formula", kExample);
  }
  const std::string name(trimmed(text.substr(0, equals)));
  require_formula_name(name, "formula");
  return words_of_law(name, text.substr(equals + 1));
}

// Drives are found by `place`, which may make a place for a name that is new.
template <typename Place>
StateDeclaration declaration_of(const Words& words, std::size_t inputs, const Place& place) {
  const std::string where = fmt::format("state '{}'", words.name);
  StateDeclaration state{words.name, find_state_law(words.law, where), {}, {}};
  const StateLawInfo& law = state_law_info(state.law);
  std::vector<std::string> known;
  for (const StateParameter& parameter : law.parameters) known.push_back(parameter.name);
  state.parameters.assign(known.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> given(known.size(), false);
  for (const std::string& argument : words.arguments) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      state.drives.push_back(place(argument, where));
      continue;
    }
    const std::string_view key = trimmed(std::string_view(argument).substr(0, equals));
    const auto at = place_of(known, key);
    if (!at) {
      throw_bad_input(fmt::format("'{}' has no parameter '{}'", law.name, key), where,
                      did_you_mean(key, known));
    }
    if (given[*at]) throw_bad_input(fmt::format("{} is given twice", key), where, "give it once");
    const std::string_view number = trimmed(std::string_view(argument).substr(equals + 1));
    const std::optional<double> value = read_number<double>(number);
    if (!value) {
      throw_bad_input(fmt::format("{} is '{}', which is no number", key, number), where,
                      "write a number");
    }
    state.parameters[*at] = *value;
    given[*at] = true;
  }
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!given[k]) {
      throw_bad_input(fmt::format("{} is missing", known[k]), where,
                      fmt::format("'{}' has {}", law.name, fmt::join(known, ", ")));
    }
  }
  check_state(state, std::max(inputs, std::size_t{1}));
  return state;
}

// The declarations and the formula's own text, which comes last.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts = split(text, ';');
  if (parts.empty()) parts.emplace_back();
  return parts;
}

void refuse_taken(const std::string& name, std::span<const std::string> names,
                  const std::vector<StateDeclaration>& states) {
  const bool taken = place_of(names, name) ||
                     std::ranges::find(states, name, &StateDeclaration::name) != states.end();
  if (taken) {
    throw_bad_input(fmt::format("the name '{}' is taken", name), fmt::format("state '{}'", name),
                    "give the state a name that no input and no other state has");
  }
}

auto among(std::span<const std::string> names) {
  return [names](const std::string& name, const std::string& where) {
    const auto at = place_of(names, name);
    if (at) return *at;
    throw_bad_input(fmt::format("it is driven by '{}', which is no input", name), where,
                    did_you_mean(name, {names.begin(), names.end()}));
  };
}

std::vector<std::string> with_states(std::span<const std::string> names,
                                     const std::vector<StateDeclaration>& states) {
  std::vector<std::string> all(names.begin(), names.end());
  for (const StateDeclaration& state : states) all.push_back(state.name);
  return all;
}

}  // namespace

bool declares_states(std::string_view text) { return text.find(';') != std::string_view::npos; }

StatefulFormula parse_stateful(std::string_view text, std::span<const std::string> names) {
  const std::vector<std::string> parts = parts_of(text);
  StatefulFormula result{{}, names.size(), {}};
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const Words words = words_of_declaration(parts[i]);
    refuse_taken(words.name, names, result.states);
    result.states.push_back(declaration_of(words, names.size(), among(names)));
  }
  result.formula = parse(parts.back(), with_states(names, result.states));
  return result;
}

StatefulFormula parse_stateful_collecting(std::string_view text, std::vector<std::string>& names) {
  const std::vector<std::string> parts = parts_of(text);
  // Inputs are known only when all is read: until then states stand before the new ones.
  StatefulFormula result;
  const auto collect = [&names](const std::string& name, const std::string& where) {
    if (const auto at = place_of(names, name)) return *at;
    require_formula_name(name, where);
    names.push_back(name);
    return names.size() - 1;
  };
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const Words words = words_of_declaration(parts[i]);
    result.states.push_back(
        declaration_of(words, std::numeric_limits<std::size_t>::max(), collect));
  }
  std::vector<StateDeclaration> before;
  for (const StateDeclaration& state : result.states) {
    refuse_taken(state.name, names, before);
    before.push_back(state);
  }
  const std::size_t known = names.size();
  std::vector<std::string> all = with_states(names, result.states);
  const Expression formula = parse_collecting_names(parts.back(), all);
  const std::size_t states = result.states.size();
  const auto first_new = all.begin() + static_cast<std::ptrdiff_t>(known + states);
  names.insert(names.end(), first_new, all.end());
  result.first_state = names.size();
  std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
  for (Node& node : nodes) {
    if (!node.is_variable() || node.variable < known) continue;
    const bool is_state = node.variable < known + states;
    node = Node::input(is_state ? node.variable - known + names.size() : node.variable - states);
  }
  result.formula = Expression(std::move(nodes));
  return result;
}

StatefulFormula parse_stateful_over(std::string_view text, NamedBox& box) {
  const std::vector<std::string> parts = parts_of(text);
  StatefulFormula result{{}, box.names.size(), {}};
  const std::vector<std::string> inputs = box.names;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const Words words = words_of_declaration(parts[i]);
    refuse_taken(words.name, inputs, result.states);
    result.states.push_back(declaration_of(words, inputs.size(), among(inputs)));
    const StateDeclaration& state = result.states.back();
    std::vector<StateRange> drives;
    for (const std::size_t drive : state.drives) {
      drives.push_back({box.ranges[drive].low, box.ranges[drive].high});
    }
    const StateRange range = state_range(state.law, state.parameters, drives);
    box.names.push_back(state.name);
    box.ranges.push_back({range.low, range.high});
  }
  result.formula = parse_over(parts.back(), box);
  return result;
}

std::string print_state_law(const StateDeclaration& state, std::span<const std::string> names) {
  const StateLawInfo& law = state_law_info(state.law);
  std::string text = law.name + "(";
  for (std::size_t i = 0; i < state.drives.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", names[state.drives[i]]);
  }
  for (std::size_t k = 0; k < law.parameters.size(); ++k) {
    text += fmt::format(", {}={}", law.parameters[k].name, print_number(state.parameters[k]));
  }
  return text + ")";
}

std::string print_stateful(const StatefulFormula& formula, std::span<const std::string> names) {
  std::string text;
  for (std::size_t k = 0; k < formula.states.size(); ++k) {
    const std::size_t column = formula.first_state + k;
    const bool is_read = std::ranges::any_of(formula.formula.nodes(), [column](const Node& node) {
      return node.is_variable() && node.variable == column;
    });
    if (!is_read) continue;
    text +=
        fmt::format("{} = {}; ", formula.states[k].name, print_state_law(formula.states[k], names));
  }
  return text +
         print(formula.formula, with_states(names.first(formula.first_state), formula.states));
}

StateDeclaration parse_state_law(std::string_view name, std::string_view law,
                                 std::span<const std::string> names) {
  return declaration_of(words_of_law(name, law), names.size(), among(names));
}

}  // namespace tribench
