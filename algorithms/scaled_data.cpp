// SPDX-License-Identifier: MIT
#include "algorithms/scaled_data.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tribench {
namespace {

constexpr int kFarFromOne = 100;  // 2^100 is 1.3e30
constexpr int kFarthestStep = 1000;

// The power of two that the largest number of the column lies at; 0 where that is near 1.
int scale_exponent(std::span<const double> column) {
  double largest = 0;
  for (const double value : column) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  if (largest == 0) return 0;
  const int exponent = std::ilogb(largest);
  return std::abs(exponent) > kFarFromOne ? exponent : 0;
}

std::vector<double> divided(std::span<const double> column, int exponent) {
  std::vector<double> scaled;
  scaled.reserve(column.size());
  for (const double value : column) scaled.push_back(std::ldexp(value, -exponent));
  return scaled;
}

}  // namespace

ScaledData::ScaledData(const TrainingData& data)
    : inputs_(data.inputs.begin(), data.inputs.end()),
      columns_(data.columns.begin(), data.columns.end()),
      target_(data.target),
      movement_(data.movement),
      motion_(data.motion),
      motion_row_(data.motion_row) {
  copies_.reserve(columns_.size());
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const std::span<const double> column(columns_[j], data.rows());
    const int exponent = scale_exponent(column);
    exponents_.push_back(exponent);
    if (exponent == 0) continue;
    is_scaled_ = true;
    columns_[j] = copies_.emplace_back(divided(column, exponent)).data();
    inputs_[j].low = std::ldexp(inputs_[j].low, -exponent);
    inputs_[j].high = std::ldexp(inputs_[j].high, -exponent);
  }
  target_exponent_ = scale_exponent(target_);
  if (target_exponent_ == 0) return;
  is_scaled_ = true;
  target_copy_ = divided(target_, target_exponent_);
  target_ = target_copy_;
}

Expression ScaledData::unscaled(const Expression& formula) const {
  if (!is_scaled_) return formula;
  std::vector<Node> nodes;
  // In steps: 2^1074, which the smallest subnormal number is brought to 1 by, is no double.
  const auto times_two_to = [&nodes](int exponent) {
    while (exponent != 0) {
      const int step = std::clamp(exponent, -kFarthestStep, kFarthestStep);
      nodes.push_back(Node::constant(std::ldexp(1.0, step)));
      nodes.push_back({0, 1, 0, Op::mul});
      exponent -= step;
    }
  };
  for (const Node& node : formula.nodes()) {
    nodes.push_back(node);
    if (node.is_variable() && exponents_[node.variable] != 0) {
      times_two_to(-exponents_[node.variable]);
    }
  }
  if (target_exponent_ != 0) times_two_to(target_exponent_);
  return Expression(std::move(nodes));
}

}  // namespace tribench
