// SPDX-License-Identifier: MIT
#include "algorithms/fitting/held_out_choice.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "algorithms/fitting/cross_validation.hpp"

namespace tribench {
namespace {

constexpr double kPlainly = 2;  // times the smallest held-out error

double variance_of(std::span<const double> target) {
  const auto n = static_cast<double>(target.size());
  double mean = 0;
  for (const double y : target) mean += y / n;
  double square = 0;
  for (const double y : target) square += (y - mean) * (y - mean) / n;
  return square;
}

}  // namespace

std::size_t held_out_choice(std::span<const Expression> front, std::size_t chosen,
                            const Inputs& inputs, std::span<const double> target,
                            std::span<const int> movement) {
  if (front.size() < 2 || target.size() > kFewRows) return chosen;
  std::vector<int> rows;
  if (movement.empty()) {
    rows.resize(target.size());
    std::iota(rows.begin(), rows.end(), 0);
    movement = rows;
  }
  const CrossValidation validation = cross_validate(front, inputs, target, movement);
  if (validation.mean_square.size() != front.size()) return chosen;
  const double own = validation.mean_square[chosen];
  const double least = std::ranges::min(validation.mean_square);
  const bool stands = own <= kPlainly * least && own <= variance_of(target);
  return stands ? chosen : validation.chosen;
}

}  // namespace tribench
