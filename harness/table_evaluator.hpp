// SPDX-License-Identifier: MIT
//
// Evaluates formulas over a problem's tables. Column j of a table is variable j of the formula.
#pragma once

#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "problems/problem.hpp"

namespace tribench {

// A table as an evaluator reads it; owns pointers only, the table must outlive it.
class TableInputs {
 public:
  explicit TableInputs(const Table& table) : rows_(table.rows()) {
    columns_.reserve(table.columns.size());
    for (const std::vector<double>& column : table.columns) columns_.push_back(column.data());
  }
  Inputs inputs() const { return {columns_, rows_}; }

 private:
  std::vector<const double*> columns_;
  std::size_t rows_;
};

// Keeps its buffers between calls. One per thread.
class TableEvaluator {
 public:
  // A value a row, not finite where the formula has none; valid until the next call.
  std::span<const double> evaluate(const Expression& formula, const Table& table) {
    values_.resize(table.rows());
    evaluator_.evaluate(formula, TableInputs(table).inputs(), values_);
    return values_;
  }

 private:
  Evaluator evaluator_;
  std::vector<double> values_;
};

}  // namespace tribench
