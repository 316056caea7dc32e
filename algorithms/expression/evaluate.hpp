// SPDX-License-Identifier: MIT
//
// Values of a formula over columns of data, in double or in float.
//
// How: the tape is translated into a short list of block kernels (one or two operations each),
// which run over blocks of rows that stay in the first-level cache; columns and constants are read
// in place. Translation costs a few nanoseconds a node and allocates nothing once the workspace
// has grown to the largest formula seen.
//
// NaN policy: IEEE semantics throughout. log of a negative number is NaN, 1/0 is infinite, exp
// overflows to infinity; nothing is masked, clipped or protected.
//
// Accuracy: + - * / sqrt abs neg sgn are exact or correctly rounded. x^n with an integer constant
// |n| <= 64 is a product of squares (1 / that for n < 0). exp log sin cos tanh atan are within 2
// ulp, any other power within 1 (foundation/elementary/). No function is the C library's.
//
// Same bits for any vector level, split of the rows, number of threads, and for one row alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench {

// Read-only columns: columns[j] points at `rows` values of variable j. Columns that start at a
// multiple of 64 bytes are read fastest.
template <typename T>
struct BasicInputs {
  std::span<const T* const> columns;
  std::size_t rows = 0;
};
using Inputs = BasicInputs<double>;

enum class ErrorSumStatus {
  complete,
  above_bound,  // the sum over the first rows is above the bound: so is the whole sum
  not_finite,   // a value or an error is not finite: so is the whole sum
};

struct ErrorSum {
  double sum = 0;        // over the rows done
  std::size_t rows = 0;  // how many were done
  ErrorSumStatus status = ErrorSumStatus::complete;
};

inline constexpr double kNoBound = 1.7976931348623157e308;

// Evaluates formulas; keeps its workspace between calls. One per thread.
template <typename T>
class BasicEvaluator {
 public:
  explicit BasicEvaluator(VectorLevel level = vector_level());
  ~BasicEvaluator();
  BasicEvaluator(BasicEvaluator&&) noexcept;
  BasicEvaluator& operator=(BasicEvaluator&&) noexcept;

  // out[r] = formula at row r; out.size() == inputs.rows. Every column the formula uses must be
  // there. out must not overlap the columns.
  void evaluate(const Expression& formula, const BasicInputs<T>& inputs, std::span<T> out);

  // Value at one point; point[j] is variable j.
  T evaluate_at(const Expression& formula, std::span<const T> point);

  // sum_r (formula(r) - target[r])^2, given up as soon as it is above `bound` or not finite. Rows
  // are added to 16 running sums in turn (row r to sum r mod 16) and those pairwise, so that the
  // result does not depend on the vector level. Errors are rounded to T, their squares summed in
  // double.
  ErrorSum sum_squared_errors(const Expression& formula, const BasicInputs<T>& inputs,
                              std::span<const T> target, double bound = kNoBound);

  VectorLevel level() const { return level_; }

 private:
  struct Workspace;
  VectorLevel level_;
  std::unique_ptr<Workspace> workspace_;
};

extern template class BasicEvaluator<double>;
extern template class BasicEvaluator<float>;
using Evaluator = BasicEvaluator<double>;
using FloatEvaluator = BasicEvaluator<float>;

// What an evaluation costs, in the unit of budgets: nodes times rows.
inline std::uint64_t node_rows(const Expression& formula, std::size_t rows) {
  return static_cast<std::uint64_t>(formula.size()) * rows;
}

// Whether x^value is computed as a product of squares.
inline constexpr double kLargestProductPower = 64;
constexpr bool is_product_power(double value) {
  return value >= -kLargestProductPower && value <= kLargestProductPower &&
         static_cast<double>(static_cast<int>(value)) == value;
}

}  // namespace tribench
