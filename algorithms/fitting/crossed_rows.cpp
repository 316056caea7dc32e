// SPDX-License-Identifier: MIT
#include "algorithms/fitting/crossed_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "foundation/random.hpp"

namespace tribench {
namespace {

constexpr std::size_t kCrossings = 1000;
// Times the target's range (docs/settled.md).
constexpr double kStrays = 10;

}  // namespace

CrossedRows::CrossedRows(const Inputs& inputs, std::span<const double> target, const InputBox& box)
    : values_(kCrossings) {
  const auto n = static_cast<double>(target.size());
  for (const double y : target) mean_ += y / n;
  const auto [least, most] = std::ranges::minmax(target);
  range_ = most - least;
  const std::size_t width = inputs.columns.size();
  std::vector<std::vector<std::size_t>> from(width, std::vector<std::size_t>(kCrossings));
  RandomStream random(key_of("crossed rows"));
  for (std::size_t j = 0; j < width; ++j) {
    for (std::size_t& row : from[j]) row = random.below(target.size());
  }
  for (std::size_t j = 0; j < width; ++j) {
    const std::size_t with = j < box.size() && box[j].sign_of ? *box[j].sign_of : j;
    std::vector<double>& column = columns_.emplace_back();
    for (const std::size_t row : from[with]) column.push_back(inputs.columns[j][row]);
  }
  for (const std::vector<double>& column : columns_) pointers_.push_back(column.data());
}

bool CrossedRows::strays(const Expression& formula) {
  evaluator_.evaluate(formula, {pointers_, kCrossings}, values_);
  return range_ > 0 && std::ranges::any_of(values_, [this](double value) {
           return std::abs(value - mean_) > kStrays * range_;  // never where it is no number
         });
}

}  // namespace tribench
