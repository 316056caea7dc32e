// SPDX-License-Identifier: MIT
//
// Every way of evaluating a formula gives the same bits: all vector levels, compiled code, one row
// alone, in double and in float.
#include <bit>
#include <cmath>

#include "algorithms/expression/compile.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/fuzz/formula_bytes.hpp"

namespace {

using namespace tribench;

template <typename T>
using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

// NaN is NaN, whatever its payload.
template <typename T>
bool same(T a, T b) {
  return std::bit_cast<Bits<T>>(a) == std::bit_cast<Bits<T>>(b) || (std::isnan(a) && std::isnan(b));
}

template <typename T>
void expect_same(const std::vector<T>& a, const std::vector<T>& b, const Expression& formula,
                 const std::string& how) {
  for (std::size_t r = 0; r < a.size(); ++r) {
    if (same(a[r], b[r])) continue;
    const std::vector<std::string> names = {"x", "y", "z"};
    fuzz::wrong(how + " differs in row " + std::to_string(r) + " of " + print(formula, names));
  }
}

template <typename T>
std::vector<std::vector<T>> columns_from(fuzz::Decisions decisions, std::size_t rows) {
  std::vector<std::vector<T>> columns(fuzz::kFormulaInputs, std::vector<T>(rows));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::vector<T>& column : columns) column[r] = static_cast<T>(decisions.number());
  }
  return columns;
}

template <typename T>
void compare(const Expression& formula, const fuzz::Decisions& decisions, std::size_t rows) {
  const std::vector<std::vector<T>> columns = columns_from<T>(decisions, rows);
  std::vector<const T*> starts;
  for (const std::vector<T>& column : columns) starts.push_back(column.data());
  const BasicInputs<T> inputs{starts, rows};
  std::vector<T> constants;
  for (const std::size_t position : constant_positions(formula)) {
    constants.push_back(static_cast<T>(formula.node(position).value));
  }
  std::vector<T> reference(rows);
  BasicEvaluator<T> baseline(VectorLevel::baseline);
  baseline.evaluate(formula, inputs, reference);
  for (const VectorLevel level : available_vector_levels()) {
    const std::string name(vector_level_name(level));
    std::vector<T> values(rows);
    BasicEvaluator<T>(level).evaluate(formula, inputs, values);
    expect_same(reference, values, formula, name);
    if (auto code = BasicCompiledFormula<T>::compile(formula, level)) {
      code->evaluate(constants, inputs, values);
      expect_same(reference, values, formula, name + " compiled");
    }
  }
  std::vector<T> alone(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    std::vector<T> point;
    for (const std::vector<T>& column : columns) point.push_back(column[r]);
    alone[r] = baseline.evaluate_at(formula, point);
  }
  expect_same(reference, alone, formula, "one row alone");
}

}  // namespace

TRIBENCH_FUZZ_TARGET(evaluate) {
  fuzz::Decisions decisions(input);
  const std::size_t rows = 1 + decisions.below(40);
  const Expression formula = fuzz::formula_from(decisions);
  compare<double>(formula, decisions, rows);
  compare<float>(formula, decisions, rows);
}
