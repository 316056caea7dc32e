// SPDX-License-Identifier: MIT
//
// What a template computes from inputs alone: further columns beside those of the inputs, each
// computed once. Inputs are columns 0 to inputs - 1, the further ones follow.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/pysr/rows.hpp"

namespace tribench::pysr {

class ComputedColumns {
 public:
  explicit ComputedColumns(std::size_t inputs) : inputs_(inputs) {}

  // The leaf that stands for a formula of the inputs: the input it is, or a further column.
  Node leaf_of(const Expression& formula);
  // The formulas of the further columns, over the inputs.
  std::span<const Expression> formulas() const { return formulas_; }
  // Of a further column; null for an input.
  const Expression* formula_of(std::size_t column) const;

  // The rows with the further columns. Throws Error (bad_input) where a value is not finite; names
  // of the inputs, for the message.
  Rows extended(Rows rows, std::span<const std::string> names) const;
  // A formula of columns as one of the inputs.
  Expression written_out(const Expression& formula) const;

 private:
  std::size_t inputs_;
  std::vector<Expression> formulas_;
};

}  // namespace tribench::pysr
