// SPDX-License-Identifier: MIT
#include "harness/loop/controller_code.hpp"

#include <algorithm>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench::loop {

NamedFormula with_formulas(const Expression& formula, std::span<const std::string> names,
                           const std::map<std::string, std::string>& formulas) {
  NamedFormula out{{}, {names.begin(), names.end()}};
  const auto reads = [&](const std::string& name) {
    return std::ranges::any_of(formula.nodes(), [&](const Node& node) {
      return node.is_variable() && names[node.variable] == name;
    });
  };
  std::vector<Expression> inputs;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto found = formulas.find(names[j]);
    const bool stays = found == formulas.end() || reads("sgn_" + names[j]);
    inputs.push_back(stays ? build::input(j) : parse_collecting_names(found->second, out.names));
  }
  out.formula = build::substituted(formula, inputs);
  return out;
}

std::string controller_code(const Expression& formula, std::span<const std::string> names,
                            const ExportOptions& options, std::optional<PathFrom> path) {
  std::string code = export_code(formula, names, CodeForm::c, options);
  const std::vector<std::string> called = export_arguments(formula, names, options);
  if (path && std::ranges::any_of(called, is_distance)) {
    code += c_history_code(options.function, called, *path);
  }
  return code;
}

}  // namespace tribench::loop
