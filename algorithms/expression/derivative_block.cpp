// SPDX-License-Identifier: MIT
#include "algorithms/expression/derivative_block.hpp"

#include <algorithm>
#include <cstdint>

#include "algorithms/expression/column_kernels.hpp"

namespace tribench {
namespace {

using Step = DerivativePlan::Step;

constexpr std::size_t kLanes = 8;  // rows of a cache line
// Blocks are as long as a workspace of this many bytes allows (half of a small second-level
// cache), within the two bounds: shorter ones pay for calls, longer ones for cache misses.
constexpr std::size_t kWorkspaceBytes = std::size_t{256} * 1024;
constexpr std::size_t kShortestBlock = 128;
constexpr std::size_t kLongestBlock = 512;

}  // namespace

std::size_t DerivativeBlock::begin(const DerivativePlan& plan, std::size_t rows) {
  const std::size_t places = plan.steps().size();
  columns_.resize(places);
  adjoints_.resize(places);
  slot_count_ = plan.slots();
  const std::size_t fits = kWorkspaceBytes / sizeof(double) / (slot_count_ + kSpareSlots);
  const std::size_t block = std::clamp(fits / kLanes * kLanes, kShortestBlock, kLongestBlock);
  stride_ = std::min(block, (rows + kLanes - 1) / kLanes * kLanes);
  const std::size_t needed = (slot_count_ + kSpareSlots) * stride_ + kLanes;
  if (memory_.size() < needed) memory_.resize(needed);
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
  const std::size_t past_line = address / sizeof(double) % kLanes;
  begin_ = memory_.data() + (past_line == 0 ? 0 : kLanes - past_line);
  return block;
}

void DerivativeBlock::forward(const DerivativePlan& plan, const Inputs& inputs, std::size_t row,
                              std::size_t n) {
  const auto steps = plan.steps();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (plan.is_scalar(i)) continue;
    if (step.op == Op::variable) {
      columns_[i] = inputs.columns[step.a] + row;
      continue;
    }
    double* out = slot(step.value_slot);
    columns_[i] = out;
    if (step.op == Op::pow) {
      forward_power(plan, step, out, n);
    } else if (arity(step.op) == 2) {
      forward_binary(plan, step, out, n);
    } else {
      forward_unary(step, out, n);
    }
  }
}

void DerivativeBlock::forward_unary(const Step& step, double* out, std::size_t n) const {
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
    case Op::atan:
      return columns::atan(a, out, n);
    default:
      return columns::sgn(a, out, n);
  }
}

void DerivativeBlock::forward_binary(const DerivativePlan& plan, const Step& step, double* out,
                                     std::size_t n) const {
  const double* a = columns_[step.a];
  const double* b = columns_[step.b];
  const double a_scalar = plan.scalar(step.a);
  const double b_scalar = plan.scalar(step.b);
  const bool both = !plan.is_scalar(step.a) && !plan.is_scalar(step.b);
  const bool left = plan.is_scalar(step.b);  // the column is on the left
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

void DerivativeBlock::forward_power(const DerivativePlan& plan, const Step& step, double* out,
                                    std::size_t n) {
  if (step.whole_power) return columns::integer_power(columns_[step.a], step.exponent, out, n);
  const double* base = column_of(plan, step.a, spare(kTemporary), n);
  columns::pow(base, column_of(plan, step.b, spare(kWeighted), n), out, n);
}

const double* DerivativeBlock::column_of(const DerivativePlan& plan, std::size_t place,
                                         double* spare_column, std::size_t n) const {
  if (!plan.is_scalar(place)) return columns_[place];
  std::fill_n(spare_column, n, plan.scalar(place));
  return spare_column;
}

}  // namespace tribench
