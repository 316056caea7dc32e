// SPDX-License-Identifier: MIT
#include "algorithms/expression/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "algorithms/expression/export_forms.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

constexpr std::string_view kSign = "sgn_";

// Reserved by C, Python or MATLAB, or used by the code around the formula.
constexpr std::array<std::string_view, 97> kReserved = {
    "auto",      "break",  "case",       "char",     "const",    "continue", "default",  "do",
    "double",    "else",   "enum",       "extern",   "float",    "for",      "goto",     "if",
    "inline",    "int",    "long",       "register", "restrict", "return",   "short",    "signed",
    "sizeof",    "static", "struct",     "switch",   "typedef",  "union",    "unsigned", "void",
    "volatile",  "while",  "and",        "as",       "assert",   "async",    "await",    "class",
    "def",       "del",    "elif",       "except",   "finally",  "from",     "global",   "import",
    "in",        "is",     "lambda",     "nonlocal", "not",      "or",       "pass",     "raise",
    "try",       "with",   "yield",      "None",     "True",     "False",    "end",      "function",
    "otherwise", "parfor", "persistent", "spmd",     "catch",    "classdef", "elseif",   "np",
    "sp",        "pi",     "NaN",        "Inf",      "main",     "y0",       "y1",       "yn",
    "j0",        "j1",     "jn",         "exp",      "log",      "sqrt",     "abs",      "sgn",
    "sin",       "cos",    "tanh",       "pow",      "fabs",     "sign",     "gamma",    "beta",
    "eye"};

bool is_identifier(std::string_view name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  });
}

std::string safe_name(const std::string& name, const std::string& function) {
  const bool taken =
      name == function || std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end();
  return taken ? fmt::format("{}_", name) : name;
}

// Adds an argument unless it is there; returns its place.
std::size_t argument_place(CodeInputs& inputs, const std::string& name,
                           const std::string& function) {
  for (std::size_t i = 0; i < inputs.arguments.size(); ++i) {
    if (inputs.arguments[i].name == name) return i;
  }
  inputs.arguments.push_back({name, safe_name(name, function), {}});
  return inputs.arguments.size() - 1;
}

CodeInputs inputs_of(const Expression& formula, std::span<const std::string> names,
                     const ExportOptions& options) {
  CodeInputs inputs;
  if (options.box) {
    for (std::size_t i = 0; i < options.box->names.size(); ++i) {
      if (options.box->names[i].starts_with(kSign)) continue;
      const std::size_t at = argument_place(inputs, options.box->names[i], options.function);
      inputs.arguments[at].range = options.box->ranges[i];
    }
  }
  inputs.columns.resize(names.size());
  for (const Node& node : formula.nodes()) {
    if (!node.is_variable()) continue;
    const std::string& name = names[node.variable];
    CodeInputs::Column& column = inputs.columns[node.variable];
    column.is_sign = name.starts_with(kSign) && name.size() > kSign.size();
    const std::string base = column.is_sign ? name.substr(kSign.size()) : name;
    column.argument = argument_place(inputs, base, options.function);
    column.name = column.is_sign
                      ? fmt::format("{}{}", kSign, inputs.arguments[column.argument].name)
                      : inputs.arguments[column.argument].code_name;
    column.is_used = true;
  }
  return inputs;
}

}  // namespace

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
  for (const CodeInputs::Argument& one : inputs_of(formula, names, options).arguments) {
    all.push_back(one.code_name);
  }
  return all;
}

std::string export_code(const Expression& formula, std::span<const std::string> names,
                        CodeForm form, const ExportOptions& options) {
  if (!is_identifier(options.function) || safe_name(options.function, "") != options.function) {
    throw_bad_input(fmt::format("'{}' cannot name a function", options.function), "--function",
                    "use letters, digits and _, and no word that a language reserves");
  }
  const CodeInputs inputs = inputs_of(formula, names, options);
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
