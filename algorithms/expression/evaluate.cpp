// SPDX-License-Identifier: MIT
#include "algorithms/expression/evaluate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "algorithms/expression/program.hpp"

namespace tribench {
namespace {

// Rows between two looks at the bound: shorter than a block can be, so that giving up is early.
template <typename T>
constexpr std::size_t kRowsALook = 2048 / sizeof(T);
static_assert(kRowsALook<double> <= kBlockRows<double> && kRowsALook<float> <= kBlockRows<float>);

// Pairwise, in a fixed order.
double total_of(std::array<double, 16> sums) {
  for (std::size_t half = 8; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) sums[i] += sums[i + half];
  }
  return sums[0];
}

}  // namespace

template <typename T>
struct BasicEvaluator<T>::Workspace {
  explicit Workspace(VectorLevel level)
      : kernels(kernel_table<T>(level)), program(level), block(kRowsALook<T>) {}
  const KernelTable<T>& kernels;
  Program<T> program;
  std::vector<T> block;
  std::vector<const T*> point;
};

template <typename T>
BasicEvaluator<T>::BasicEvaluator(VectorLevel level)
    : level_(level), workspace_(std::make_unique<Workspace>(level)) {}
template <typename T>
BasicEvaluator<T>::~BasicEvaluator() = default;
template <typename T>
BasicEvaluator<T>::BasicEvaluator(BasicEvaluator&&) noexcept = default;
template <typename T>
BasicEvaluator<T>& BasicEvaluator<T>::operator=(BasicEvaluator&&) noexcept = default;

template <typename T>
void BasicEvaluator<T>::evaluate(const Expression& formula, const BasicInputs<T>& inputs,
                                 std::span<T> out) {
  Program<T>& program = workspace_->program;
  program.translate(formula, inputs.columns, out.data(), Program<T>::Result::rows);
  for (std::size_t row = 0; row < inputs.rows; row += kBlockRows<T>) {
    program.run(row, std::min(kBlockRows<T>, inputs.rows - row));
  }
}

template <typename T>
T BasicEvaluator<T>::evaluate_at(const Expression& formula, std::span<const T> point) {
  std::vector<const T*>& columns = workspace_->point;
  columns.resize(point.size());
  for (std::size_t j = 0; j < point.size(); ++j) columns[j] = &point[j];
  T value = 0;
  evaluate(formula, {columns, 1}, {&value, 1});
  return value;
}

template <typename T>
ErrorSum BasicEvaluator<T>::sum_squared_errors(const Expression& formula,
                                               const BasicInputs<T>& inputs,
                                               std::span<const T> target, double bound) {
  Workspace& work = *workspace_;
  work.program.translate(formula, inputs.columns, work.block.data(), Program<T>::Result::block);
  alignas(64) std::array<double, 16> sums{};
  ErrorSum result;
  while (result.rows < inputs.rows) {
    const std::size_t n = std::min(kRowsALook<T>, inputs.rows - result.rows);
    work.program.run(result.rows, n);
    work.kernels.add_squared_errors(sums.data(), work.block.data(), target.data() + result.rows, n);
    result.rows += n;
    result.sum = total_of(sums);
    if (!std::isfinite(result.sum)) {
      result.status = ErrorSumStatus::not_finite;
      return result;
    }
    if (result.sum > bound) {
      result.status = ErrorSumStatus::above_bound;
      return result;
    }
  }
  return result;
}

template class BasicEvaluator<double>;
template class BasicEvaluator<float>;

}  // namespace tribench
