// SPDX-License-Identifier: MIT
#include "algorithms/pysr/computed_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr {

Node ComputedColumns::leaf_of(const Expression& formula) {
  if (formula.node(formula.root()).is_variable()) return formula.node(formula.root());
  const auto known = std::ranges::find(formulas_, formula);
  const auto place = static_cast<std::size_t>(known - formulas_.begin());
  if (known == formulas_.end()) formulas_.push_back(formula);
  return Node::input(inputs_ + place);
}

const Expression* ComputedColumns::formula_of(std::size_t column) const {
  return column < inputs_ ? nullptr : &formulas_[column - inputs_];
}

Rows ComputedColumns::extended(Rows rows, std::span<const std::string> names) const {
  Evaluator evaluator;
  std::vector<std::vector<double>> columns;
  for (const Expression& formula : formulas_) {
    std::vector<double> values(rows.size());
    evaluator.evaluate(formula, rows.inputs(), values);
    const auto bad = std::ranges::find_if(values, [](double x) { return !std::isfinite(x); });
    if (bad != values.end()) {
      throw_bad_input(fmt::format("'{}' is {} in row {} of the complete rows",
                                  print(formula, names), *bad, bad - values.begin() + 1),
                      "template", "let the template compute only what the data allow");
    }
    columns.push_back(std::move(values));
  }
  columns.insert(columns.begin(), std::make_move_iterator(rows.columns.begin()),
                 std::make_move_iterator(rows.columns.end()));
  return {std::move(columns), std::move(rows.target)};
}

Expression ComputedColumns::written_out(const Expression& formula) const {
  if (formulas_.empty()) return formula;
  std::vector<Node> tape;
  for (const Node& node : formula.nodes()) {
    const Expression* further_column = node.is_variable() ? formula_of(node.variable) : nullptr;
    if (further_column == nullptr) {
      tape.push_back(node);
    } else {
      tape.insert(tape.end(), further_column->nodes().begin(), further_column->nodes().end());
    }
  }
  return Expression(std::move(tape));
}

}  // namespace tribench::pysr
