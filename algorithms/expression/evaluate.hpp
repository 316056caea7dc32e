// SPDX-License-Identifier: MIT
//
// Values of a formula over columns of data, in blocks that stay in cache.
//
// NaN policy: IEEE double semantics throughout. log of a negative number is NaN, 1/0 is infinite,
// exp overflows to infinity; nothing is masked, clipped or protected. x^n with an integer constant
// |n| <= 64 is a product of squares; any other power is std::pow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// Read-only columns: columns[j] points at `rows` doubles of variable j.
struct Inputs {
  std::span<const double* const> columns;
  std::size_t rows = 0;
};

// Evaluates formulas; keeps its workspace between calls. One per thread.
class Evaluator {
 public:
  // out[r] = formula at row r; out.size() == inputs.rows. Every column the formula uses must be
  // there. Same bits for any number of threads and any split of the rows.
  void evaluate(const Expression& formula, const Inputs& inputs, std::span<double> out);

  // Value at one point; point[j] is variable j. The same bits as `evaluate` gives for that row.
  double evaluate_at(const Expression& formula, std::span<const double> point);

 private:
  std::vector<double> workspace_;
};

// What an evaluation costs, in the unit of budgets: nodes times rows.
inline std::uint64_t node_rows(const Expression& formula, std::size_t rows) {
  return static_cast<std::uint64_t>(formula.size()) * rows;
}

}  // namespace tribench
