// SPDX-License-Identifier: MIT
#include "algorithms/expression/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "algorithms/expression/export_forms.hpp"
#include "algorithms/expression/reserved_words.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

using ArgumentPlaces = std::unordered_map<std::string, std::size_t>;

// Adds an argument unless it is there; returns its place.
std::size_t argument_place(CodeInputs& inputs, ArgumentPlaces& places, const std::string& name) {
  const auto [place, is_new] = places.try_emplace(name, inputs.arguments.size());
  if (is_new) {
    require_formula_name(name, "export");
    inputs.arguments.push_back({name, {}, {}});
  }
  return place->second;
}

// Names for the code that no language reserves and no two arguments share: of `if` and `if_` the
// first becomes if__.
void name_arguments(CodeInputs& inputs, const std::string& function) {
  std::set<std::string> taken = {function};
  for (CodeInputs::Argument& argument : inputs.arguments) {
    if (is_reserved_word(argument.name) || argument.name == function) continue;
    argument.code_name = argument.name;
    taken.insert(argument.name);
  }
  for (CodeInputs::Argument& argument : inputs.arguments) {
    if (!argument.code_name.empty()) continue;
    argument.code_name = unreserved(argument.name);
    while (!taken.insert(argument.code_name).second) argument.code_name += '_';
  }
}

}  // namespace

CodeInputs code_inputs(const Expression& formula, std::span<const std::string> names,
                       const ExportOptions& options) {
  CodeInputs inputs;
  ArgumentPlaces places;
  if (options.box) {
    for (std::size_t i = 0; i < options.box->names.size(); ++i) {
      if (options.box->ranges[i].sign_of) continue;
      const std::size_t at = argument_place(inputs, places, options.box->names[i]);
      inputs.arguments[at].range = options.box->ranges[i];
    }
  }
  std::unordered_set<std::string_view> in_box;
  if (options.box) in_box.insert(options.box->names.begin(), options.box->names.end());
  inputs.columns.resize(names.size());
  for (const Node& node : formula.nodes()) {
    if (!node.is_variable()) continue;
    const std::string& name = names[node.variable];
    CodeInputs::Column& column = inputs.columns[node.variable];
    const bool is_called_sign = name.starts_with(kSignPrefix) && name.size() > kSignPrefix.size();
    const std::string base = is_called_sign ? name.substr(kSignPrefix.size()) : name;
    // A box that has sgn_X and no X makes it an input of its own.
    column.is_sign = is_called_sign && (in_box.contains(base) || !in_box.contains(name));
    column.argument = argument_place(inputs, places, column.is_sign ? base : name);
    column.is_used = true;
  }
  name_arguments(inputs, options.function);
  for (CodeInputs::Column& column : inputs.columns) {
    if (!column.is_used) continue;
    const std::string& called = inputs.arguments[column.argument].code_name;
    column.name = column.is_sign ? fmt::format("{}{}", kSignPrefix, called) : called;
  }
  return inputs;
}

void require_function_name(const std::string& function) {
  if (is_identifier(function) && !is_reserved_word(function)) return;
  throw_bad_input(fmt::format("'{}' cannot name a function", function), "--function",
                  "use letters, digits and _, and no word that a language reserves");
}

const std::vector<std::string>& code_form_names() {
  static const std::vector<std::string> kNames = {"c", "python", "latex", "sympy", "matlab"};
  return kNames;
}

CodeForm find_code_form(std::string_view name) {
  const auto& names = code_form_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw_bad_input(fmt::format("there is no form '{}'", name), "--as", did_you_mean(name, names));
  }
  return static_cast<CodeForm>(found - names.begin());
}

std::vector<std::string> export_arguments(const Expression& formula,
                                          std::span<const std::string> names,
                                          const ExportOptions& options) {
  std::vector<std::string> all;
  for (const CodeInputs::Argument& one : code_inputs(formula, names, options).arguments) {
    all.push_back(one.code_name);
  }
  return all;
}

std::string export_code(const Expression& formula, std::span<const std::string> names,
                        CodeForm form, const ExportOptions& options) {
  require_function_name(options.function);
  const CodeInputs inputs = code_inputs(formula, names, options);
  const CodeSource source{formula, print(formula, names), options.function, inputs, options.digits};
  switch (form) {
    case CodeForm::c:
      return c_code(source);
    case CodeForm::python:
      return python_code(source);
    case CodeForm::sympy:
      return sympy_code(source);
    case CodeForm::matlab:
      return matlab_code(source);
    default:
      return latex_code(source);
  }
}

}  // namespace tribench
