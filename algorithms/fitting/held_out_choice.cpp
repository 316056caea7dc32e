// SPDX-License-Identifier: MIT
#include "algorithms/fitting/held_out_choice.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/linear_sum.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr int kChoiceFolds = 5;
// Up to so many rows each is held out alone: of ten rows folds of two take a fifth of what there is
// to fit, and what they say hangs on which two the deal put together.
constexpr std::size_t kHeldOutAlone = 20;
constexpr int kFolds = 10;
constexpr std::size_t kFewestRows = 12;

double variance_of(std::span<const double> target) {
  const auto n = static_cast<double>(target.size());
  double mean = 0;
  for (const double y : target) mean += y / n;
  double square = 0;
  for (const double y : target) square += (y - mean) * (y - mean) / n;
  return square;
}

// How much smaller an error is because a search chose so long a form for it: the evidence's price
// of a node.
double optimism(const Expression& formula, std::size_t rows) {
  return elementary::exp(2 * kNodePrice * static_cast<double>(formula.size()) /
                         static_cast<double>(rows));
}

// And because for each input written it had the choice among all of them.
double optimism_of_inputs(const Expression& formula, const Inputs& inputs) {
  const auto written =
      static_cast<double>(std::ranges::count_if(formula.nodes(), &Node::is_variable));
  return elementary::exp(2 * written * elementary::log(static_cast<double>(inputs.columns.size())) /
                         static_cast<double>(inputs.rows));
}

}  // namespace

std::size_t held_out_choice(std::span<const Expression> front, std::size_t chosen,
                            const Inputs& inputs, std::span<const double> target,
                            std::span<const int> movement, const std::function<bool()>& in_time) {
  if (front.size() < 2 || target.size() > kFewRows) return chosen;
  std::vector<int> rows;
  if (movement.empty()) {
    rows.resize(target.size());
    std::iota(rows.begin(), rows.end(), 0);
    movement = rows;
  }
  const int folds = target.size() <= kHeldOutAlone ? static_cast<int>(target.size()) : kChoiceFolds;
  const CrossValidation validation =
      cross_validate(front, inputs, target, movement, {}, folds, in_time);
  std::vector<double> honest = validation.mean_square;
  if (honest.size() != front.size()) return chosen;
  const double own = honest[chosen];
  for (std::size_t k = 0; k < front.size(); ++k) honest[k] *= optimism(front[k], inputs.rows);
  const auto best = std::ranges::min_element(honest);
  const bool stands = honest[chosen] <= kPlainly * *best && own <= variance_of(target);
  return stands ? chosen : static_cast<std::size_t>(best - honest.begin());
}

std::optional<Expression> plain_sum_instead(const Expression& chosen, const Inputs& inputs,
                                            std::span<const double> target,
                                            std::span<const int> movement,
                                            const std::function<bool()>& in_time) {
  if (target.size() > kFewRows || target.size() < kFewestRows) return std::nullopt;
  const std::vector<int> fold = held_out_folds(movement, target.size(), kFolds);
  const CrossValidation own =
      cross_validate({&chosen, 1}, inputs, target, fold, {}, kFolds, in_time);
  if (own.mean_square.empty()) return std::nullopt;
  const LinearSum sum = fit_linear_sum(inputs, target, movement);
  const double honest =
      own.mean_square[0] * optimism(chosen, inputs.rows) * optimism_of_inputs(chosen, inputs);
  if (honest <= sum.held_out) return std::nullopt;
  return sum.formula;
}

}  // namespace tribench
