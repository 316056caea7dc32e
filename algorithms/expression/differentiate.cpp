// SPDX-License-Identifier: MIT
#include "algorithms/expression/differentiate.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/column_kernels.hpp"

namespace tribench {
namespace {

constexpr std::size_t kLanes = 8;  // rows of a cache line
// Blocks are as long as a workspace of this many bytes allows (half of a small second-level
// cache), within the two bounds: shorter ones pay for calls, longer ones for cache misses.
constexpr std::size_t kWorkspaceBytes = std::size_t{256} * 1024;
constexpr std::size_t kShortestBlock = 128;
constexpr std::size_t kLongestBlock = 512;

bool is_whole_power(const Node& exponent) {
  return exponent.is_constant() && is_product_power(exponent.value);
}

}  // namespace

void Differentiator::prepare(const Expression& formula, std::span<const std::size_t> constants) {
  parameter_count_ = constants.size();
  leaves_.clear();
  for (std::size_t k = 0; k < constants.size(); ++k) {
    leaves_.push_back({static_cast<std::uint32_t>(constants[k]), static_cast<std::uint32_t>(k)});
  }
  compile(formula);
}

void Differentiator::prepare_for_inputs(const Expression& formula, std::size_t inputs) {
  parameter_count_ = inputs;
  leaves_.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (!node.is_variable() || node.variable >= inputs) continue;
    leaves_.push_back({static_cast<std::uint32_t>(i), node.variable});
  }
  compile(formula);
}

void Differentiator::compile(const Expression& formula) {
  values_are_current_ = false;
  steps_.assign(formula.size(), Step{});
  scalars_.assign(formula.size(), 0);
  columns_.assign(formula.size(), nullptr);
  adjoints_.assign(formula.size(), Adjoint{});
  for (const Leaf& leaf : leaves_) steps_[leaf.place].wanted = true;
  stack_.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    Step& step = steps_[i];
    step.op = node.op;
    if (node.is_constant()) {
      scalars_[i] = node.value;
    } else if (node.is_variable()) {
      step.kind = Kind::column;
      step.a = node.variable;
    } else {
      if (arity(node.op) == 2) {
        step.b = stack_.back();
        stack_.pop_back();
      } else {
        step.b = stack_.back();
      }
      step.a = stack_.back();
      stack_.pop_back();
      const Step& a = steps_[step.a];
      const Step& b = steps_[step.b];
      step.kind = a.kind == Kind::column ? Kind::column : b.kind;
      step.wanted = (a.wanted || b.wanted) && node.op != Op::sgn;
      if (node.op == Op::pow && !b.wanted && is_whole_power(formula.node(step.b))) {
        step.whole_power = true;
        step.exponent = static_cast<int>(formula.node(step.b).value);
      }
    }
    stack_.push_back(static_cast<std::uint32_t>(i));
  }
  // Downwards: what lies below a sgn is not reached.
  for (std::size_t i = formula.size(); i-- > 0;) {
    const Step& step = steps_[i];
    if (step.wanted || arity(step.op) == 0) continue;
    steps_[step.a].wanted = false;
    steps_[step.b].wanted = false;
  }
  assign_slots();
}

void Differentiator::assign_slots() {
  slot_count_ = 0;
  const auto next = [this] { return static_cast<std::uint32_t>(slot_count_++); };
  for (Step& step : steps_) {
    if (step.kind == Kind::column && step.op != Op::variable) step.value_slot = next();
  }
  for (Step& step : steps_) {
    if (step.wanted) step.adjoint_slot = next();
  }
}

void Differentiator::set_constants(std::span<const double> values) {
  for (const Leaf& leaf : leaves_) scalars_[leaf.place] = values[leaf.parameter];
  values_are_current_ = false;
}

std::size_t Differentiator::begin_blocks(std::size_t rows) {
  const std::size_t fits = kWorkspaceBytes / sizeof(double) / (slot_count_ + kSpareSlots);
  const std::size_t block = std::clamp(fits / kLanes * kLanes, kShortestBlock, kLongestBlock);
  stride_ = std::min(block, (rows + kLanes - 1) / kLanes * kLanes);
  const std::size_t needed = (slot_count_ + kSpareSlots) * stride_ + kLanes;
  if (memory_.size() < needed) memory_.resize(needed);
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
  const std::size_t past_line = address / sizeof(double) % kLanes;
  memory_begin_ = memory_.data() + (past_line == 0 ? 0 : kLanes - past_line);
  forward_scalars();
  return block;
}

void Differentiator::forward_scalars() {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.kind != Kind::scalar || step.op == Op::constant) continue;
    const double a = scalars_[step.a];
    scalars_[i] = arity(step.op) == 1 ? apply(step.op, a) : apply(step.op, a, scalars_[step.b]);
  }
}

void Differentiator::forward(const Inputs& inputs, std::size_t row, std::size_t n) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.kind == Kind::scalar) continue;
    if (step.op == Op::variable) {
      columns_[i] = inputs.columns[step.a] + row;
      continue;
    }
    double* out = slot(step.value_slot);
    columns_[i] = out;
    if (step.op == Op::pow) {
      forward_power(step, out, n);
    } else if (arity(step.op) == 2) {
      forward_binary(step, out, n);
    } else {
      forward_unary(step, out, n);
    }
  }
}

void Differentiator::forward_unary(const Step& step, double* out, std::size_t n) {
  const double* a = columns_[step.a];
  switch (step.op) {
    case Op::neg:
      return columns::mul(a, -1.0, out, n);
    case Op::exp:
      return columns::exp(a, out, n);
    case Op::log:
      return columns::log(a, out, n);
    case Op::sqrt:
      return columns::sqrt(a, out, n);
    case Op::abs:
      return columns::abs(a, out, n);
    case Op::sin:
      return columns::sin(a, out, n);
    case Op::cos:
      return columns::cos(a, out, n);
    case Op::tanh:
      return columns::tanh(a, out, n);
    default:
      return columns::sgn(a, out, n);
  }
}

void Differentiator::forward_binary(const Step& step, double* out, std::size_t n) {
  const double* a = columns_[step.a];
  const double* b = columns_[step.b];
  const double a_scalar = scalars_[step.a];
  const double b_scalar = scalars_[step.b];
  const bool both = !is_scalar(step.a) && !is_scalar(step.b);
  const bool left = is_scalar(step.b);  // the column is on the left
  switch (step.op) {
    case Op::add:
      if (both) return columns::add(a, b, out, n);
      return left ? columns::add(a, b_scalar, out, n) : columns::add(b, a_scalar, out, n);
    case Op::sub:
      if (both) return columns::sub(a, b, out, n);
      return left ? columns::add(a, -b_scalar, out, n) : columns::sub(a_scalar, b, out, n);
    case Op::mul:
      if (both) return columns::mul(a, b, out, n);
      return left ? columns::mul(a, b_scalar, out, n) : columns::mul(b, a_scalar, out, n);
    default:
      if (both) return columns::div(a, b, out, n);
      return left ? columns::div(a, b_scalar, out, n) : columns::div(a_scalar, b, out, n);
  }
}

void Differentiator::forward_power(const Step& step, double* out, std::size_t n) {
  if (step.whole_power) return columns::integer_power(columns_[step.a], step.exponent, out, n);
  const double* base = column_of(step.a, spare(kTemporary), n);
  columns::pow(base, column_of(step.b, spare(kWeighted), n), out, n);
}

const double* Differentiator::column_of(std::size_t place, double* spare_column, std::size_t n) {
  if (!is_scalar(place)) return columns_[place];
  std::fill_n(spare_column, n, scalars_[place]);
  return spare_column;
}

void Differentiator::write_values(double* out, std::size_t n) const {
  const std::size_t root = steps_.size() - 1;
  if (is_scalar(root)) {
    std::fill_n(out, n, scalars_[root]);
  } else {
    std::copy_n(columns_[root], n, out);
  }
}

void Differentiator::evaluate(const Inputs& inputs, std::span<double> values) {
  const std::size_t block = begin_blocks(inputs.rows);
  values_are_current_ = false;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    forward(inputs, row, n);
    write_values(values.data() + row, n);
  }
}

void Differentiator::jacobian(const Inputs& inputs, std::span<double> values,
                              std::span<double> jacobian) {
  const std::size_t block = begin_blocks(inputs.rows);
  values_are_current_ = false;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    forward(inputs, row, n);
    if (!values.empty()) write_values(values.data() + row, n);
    backward(n);
    write_jacobian(row, n, inputs.rows, jacobian.data());
  }
}

void Differentiator::write_jacobian(std::size_t row, std::size_t n, std::size_t rows,
                                    double* jacobian) {
  written_.assign(parameter_count_, false);
  for (const Leaf& leaf : leaves_) {
    double* out = jacobian + leaf.parameter * rows + row;
    const Adjoint& adjoint = adjoints_[leaf.place];
    double* fresh = written_[leaf.parameter] ? spare(kTemporary) : out;
    if (adjoint.data == nullptr) {
      std::fill_n(fresh, n, adjoint.scale);
    } else {
      columns::mul(adjoint.data, adjoint.scale, fresh, n);
    }
    if (fresh != out) columns::add(out, fresh, out, n);
    written_[leaf.parameter] = true;
  }
  for (std::size_t k = 0; k < parameter_count_; ++k) {
    if (!written_[k]) std::fill_n(jacobian + k * rows + row, n, 0.0);
  }
}

double Differentiator::residuals(std::span<const double> target, std::span<const double> weights,
                                 std::size_t row, std::size_t n) {
  const std::size_t root = steps_.size() - 1;
  double* residual = spare(kResidual);
  if (is_scalar(root)) {
    columns::sub(scalars_[root], target.data() + row, residual, n);
  } else {
    columns::sub(columns_[root], target.data() + row, residual, n);
  }
  if (weights.empty()) return columns::dot(residual, residual, n);
  double* weighted = spare(kWeighted);
  columns::mul(residual, weights.data() + row, weighted, n);
  const double sum = columns::dot(residual, weighted, n);
  std::copy_n(weighted, n, residual);
  return sum;
}

double Differentiator::sum_squares(const Inputs& inputs, std::span<const double> target,
                                   std::span<const double> weights) {
  const std::size_t block = begin_blocks(inputs.rows);
  double sum = 0;
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    forward(inputs, row, n);
    sum += residuals(target, weights, row, n);
  }
  values_are_current_ = inputs.rows <= block;
  return sum;
}

void Differentiator::normal_equations(const Inputs& inputs, std::span<const double> target,
                                      std::span<const double> weights, NormalEquations& result) {
  const std::size_t p = parameter_count_;
  const bool reuse = values_are_current_;
  const std::size_t block = begin_blocks(inputs.rows);
  result.sum_squares = 0;
  result.gradient.assign(p, 0);
  result.curvature.assign(p * p, 0);
  for (std::size_t row = 0; row < inputs.rows; row += block) {
    const std::size_t n = std::min(block, inputs.rows - row);
    if (!reuse) forward(inputs, row, n);
    result.sum_squares += residuals(target, weights, row, n);
    backward(n);
    accumulate(weights, row, n, result);
  }
  for (std::size_t k = 0; k < p; ++k) {
    for (std::size_t l = 0; l < k; ++l) result.curvature[k * p + l] = result.curvature[l * p + k];
  }
  values_are_current_ = inputs.rows <= block;
}

void Differentiator::accumulate(std::span<const double> weights, std::size_t row, std::size_t n,
                                NormalEquations& result) {
  const std::size_t p = parameter_count_;
  double* ones = spare(kOnes);
  std::fill_n(ones, n, 1.0);
  summands_.assign(p, ones);
  scales_.assign(p, 0);
  for (const Leaf& leaf : leaves_) {
    const Adjoint& adjoint = adjoints_[leaf.place];
    if (adjoint.data != nullptr) summands_[leaf.parameter] = adjoint.data;
    scales_[leaf.parameter] = adjoint.scale;
  }
  const double* residual = spare(kResidual);  // weighted already
  for (std::size_t k = 0; k < p; ++k) {
    result.gradient[k] += scales_[k] * columns::dot(summands_[k], residual, n);
    const double* factor = summands_[k];
    if (!weights.empty()) {
      columns::mul(factor, weights.data() + row, spare(kWeighted), n);
      factor = spare(kWeighted);
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
