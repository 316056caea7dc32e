// SPDX-License-Identifier: MIT
#include "algorithms/expression/differentiate.hpp"

#include <algorithm>
#include <limits>

#include "algorithms/expression/backward_pass.hpp"
#include "algorithms/expression/column_kernels.hpp"

namespace tribench {

void Differentiator::prepare(const Expression& formula, std::span<const std::size_t> constants) {
  plan_.prepare(formula, constants);
  values_are_current_ = false;
}

void Differentiator::prepare_for_inputs(const Expression& formula, std::size_t inputs) {
  plan_.prepare_for_inputs(formula, inputs);
  values_are_current_ = false;
}

void Differentiator::set_constants(std::span<const double> values) {
  plan_.set_constants(values);
  values_are_current_ = false;
}

std::size_t Differentiator::begin_blocks(std::size_t rows) {
  plan_.compute_scalars();
  return block_.begin(plan_, rows);
}

void Differentiator::write_values(double* out, std::size_t n) const {
  const std::size_t root = plan_.root();
  if (plan_.is_scalar(root)) {
    std::fill_n(out, n, plan_.scalar(root));
  } else {
    std::copy_n(block_.values(root), n, out);
  }
}

void Differentiator::evaluate(const Inputs& inputs, std::span<double> values) {
  const std::size_t block = begin_blocks(inputs.rows);
  values_are_current_ = false;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    block_.forward(plan_, inputs, row, n);
    write_values(values.data() + row, n);
  }
}

void Differentiator::jacobian(const Inputs& inputs, std::span<double> values,
                              std::span<double> jacobian) {
  const std::size_t block = begin_blocks(inputs.rows);
  values_are_current_ = false;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    block_.forward(plan_, inputs, row, n);
    if (!values.empty()) write_values(values.data() + row, n);
    BackwardPass(plan_, block_, n).run();
    write_jacobian(row, n, inputs.rows, jacobian.data());
  }
}

void Differentiator::write_jacobian(std::size_t row, std::size_t n, std::size_t rows,
                                    double* jacobian) {
  written_.assign(plan_.parameters(), false);
  for (const DerivativePlan::Leaf& leaf : plan_.leaves()) {
    double* out = jacobian + leaf.parameter * rows + row;
    const Adjoint& adjoint = block_.adjoint(leaf.place);
    double* fresh = written_[leaf.parameter] ? block_.spare(DerivativeBlock::kTemporary) : out;
    if (adjoint.data == nullptr) {
      std::fill_n(fresh, n, adjoint.scale);
    } else {
      columns::mul(adjoint.data, adjoint.scale, fresh, n);
    }
    if (fresh != out) columns::add(out, fresh, out, n);
    written_[leaf.parameter] = true;
  }
  for (std::size_t k = 0; k < plan_.parameters(); ++k) {
    if (!written_[k]) std::fill_n(jacobian + k * rows + row, n, 0.0);
  }
}

double Differentiator::residuals(std::span<const double> target, std::span<const double> weights,
                                 std::size_t row, std::size_t n) {
  const std::size_t root = plan_.root();
  double* residual = block_.spare(DerivativeBlock::kResidual);
  if (plan_.is_scalar(root)) {
    columns::sub(plan_.scalar(root), target.data() + row, residual, n);
  } else {
    columns::sub(block_.values(root), target.data() + row, residual, n);
  }
  if (weights.empty()) return columns::dot(residual, residual, n);
  double* weighted = block_.spare(DerivativeBlock::kWeighted);
  columns::mul(residual, weights.data() + row, weighted, n);
  const double sum = columns::dot(residual, weighted, n);
  std::copy_n(weighted, n, residual);
  return sum;
}

double Differentiator::sum_squares(const Inputs& inputs, std::span<const double> target,
                                   std::span<const double> weights, const InTime& in_time) {
  const std::size_t block = begin_blocks(inputs.rows);
  double sum = 0;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    if (in_time && !in_time()) return std::numeric_limits<double>::quiet_NaN();
    const std::size_t n = std::min(block, inputs.rows - row);
    block_.forward(plan_, inputs, row, n);
    sum += residuals(target, weights, row, n);
  }
  values_are_current_ = inputs.rows <= block;
  return sum;
}

void Differentiator::normal_equations(const Inputs& inputs, std::span<const double> target,
                                      std::span<const double> weights, NormalEquations& result,
                                      const InTime& in_time) {
  const std::size_t p = plan_.parameters();
  const bool reuse = values_are_current_;
  const std::size_t block = begin_blocks(inputs.rows);
  result.sum_squares = 0;
  result.gradient.assign(p, 0);
  result.curvature.assign(p * p, 0);
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    if (in_time && !in_time()) {
      result.sum_squares = std::numeric_limits<double>::quiet_NaN();
      std::ranges::fill(result.gradient, result.sum_squares);
      return;
    }
    const std::size_t n = std::min(block, inputs.rows - row);
    if (!reuse) block_.forward(plan_, inputs, row, n);
    result.sum_squares += residuals(target, weights, row, n);
    BackwardPass(plan_, block_, n).run();
    accumulate(weights, row, n, result);
  }
  for (std::size_t k = 0; k < p; ++k) {
    for (std::size_t l = 0; l < k; ++l) result.curvature[k * p + l] = result.curvature[l * p + k];
  }
  values_are_current_ = inputs.rows <= block;
}

void Differentiator::accumulate(std::span<const double> weights, std::size_t row, std::size_t n,
                                NormalEquations& result) {
  const std::size_t p = plan_.parameters();
  double* ones = block_.spare(DerivativeBlock::kOnes);
  std::fill_n(ones, n, 1.0);
  summands_.assign(p, ones);
  scales_.assign(p, 0);
  for (const DerivativePlan::Leaf& leaf : plan_.leaves()) {
    const Adjoint& adjoint = block_.adjoint(leaf.place);
    if (adjoint.data != nullptr) summands_[leaf.parameter] = adjoint.data;
    scales_[leaf.parameter] = adjoint.scale;
  }
  const double* residual = block_.spare(DerivativeBlock::kResidual);  // weighted already
  for (std::size_t k = 0; k < p; ++k) {
    result.gradient[k] += scales_[k] * columns::dot(summands_[k], residual, n);
    const double* factor = summands_[k];
    if (!weights.empty()) {
      columns::mul(factor, weights.data() + row, block_.spare(DerivativeBlock::kWeighted), n);
      factor = block_.spare(DerivativeBlock::kWeighted);
    }
    for (std::size_t l = k; l < p; l += 4) {
      const std::size_t last = p - 1;
      const double* four[4] = {summands_[l], summands_[std::min(l + 1, last)],
                               summands_[std::min(l + 2, last)], summands_[std::min(l + 3, last)]};
      double sums[4];
      columns::dot4(factor, four, n, sums);
      for (std::size_t j = 0; j < std::min<std::size_t>(4, p - l); ++j) {
        result.curvature[k * p + l + j] += scales_[k] * scales_[l + j] * sums[j];
      }
    }
  }
}

}  // namespace tribench
