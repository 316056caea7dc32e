// SPDX-License-Identifier: MIT
#include "algorithms/fitting/exact_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"

namespace tribench {
namespace {

constexpr double kAlike = 100;
constexpr double kRounding = 1e-9;

double spread_of(std::span<const double> target) {
  const auto n = static_cast<double>(target.size());
  double mean = 0;
  for (const double y : target) mean += y / n;
  double square = 0;
  for (const double y : target) square += (y - mean) * (y - mean);
  return square;
}

}  // namespace

std::optional<std::size_t> simplest_exact(std::span<const Expression> formulas,
                                          const Inputs& inputs, std::span<const double> target) {
  const double spread = spread_of(target);
  if (formulas.empty() || !(spread > 0)) return std::nullopt;
  Evaluator evaluator;
  std::vector<double> errors;
  for (const Expression& formula : formulas) {
    const ErrorSum sum = evaluator.sum_squared_errors(formula, inputs, target);
    errors.push_back(sum.status == ErrorSumStatus::complete ? std::sqrt(sum.sum / spread)
                                                            : HUGE_VAL);
  }
  const double best = std::ranges::min(errors);
  if (!(best <= kNearlyExact)) return std::nullopt;
  const double enough = std::max(kAlike * best, kRounding);
  std::optional<std::size_t> choice;
  std::pair<int, int> least;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    const std::pair<int, int> size = {paper_complexity(formulas[i]), node_count(formulas[i])};
    if (!(errors[i] <= enough) || (choice && size >= least)) continue;
    choice = i;
    least = size;
  }
  return choice;
}

}  // namespace tribench
