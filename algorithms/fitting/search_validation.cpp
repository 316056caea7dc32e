// SPDX-License-Identifier: MIT
#include "algorithms/fitting/search_validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

// Times the target's variance: an error of a fold counts so much at most. A formula that leaves all
// bounds on one row must not be all that the folds say.
constexpr double kAsBadAsCanBe = 2;

// Times the least error of any bound: more, and the choice gives way (docs/settled.md).
constexpr double kClearly = 1.5;

}  // namespace

void SearchValidation::add(std::span<const Expression> front, std::size_t chosen,
                           const Inputs& held_out, std::span<const double> target) {
  Fold fold;
  fold.chosen = chosen;
  fold.target.assign(target.begin(), target.end());
  Evaluator evaluator;
  for (const Expression& formula : front) {
    const ErrorSum sum = evaluator.sum_squared_errors(formula, held_out, target);
    fold.complexity.push_back(paper_complexity(formula));
    fold.mean_square.push_back(sum.status == ErrorSumStatus::complete
                                   ? sum.sum / static_cast<double>(target.size())
                                   : std::numeric_limits<double>::infinity());
  }
  folds_.push_back(std::move(fold));
}

// Of the most complex formula within the bound, else of the simplest.
double SearchValidation::Fold::up_to(int complexity_bound) const {
  const auto above = std::ranges::upper_bound(complexity, complexity_bound);
  const auto within = above - complexity.begin();
  return mean_square[static_cast<std::size_t>(std::max<std::ptrdiff_t>(within - 1, 0))];
}

double SearchValidation::variance() const {
  double n = 0;
  double mean = 0;
  for (const Fold& fold : folds_) n += static_cast<double>(fold.target.size());
  for (const Fold& fold : folds_) {
    for (const double y : fold.target) mean += y / n;
  }
  double variance = 0;
  for (const Fold& fold : folds_) {
    for (const double y : fold.target) variance += (y - mean) * (y - mean) / n;
  }
  return variance;
}

template <typename Error>
double SearchValidation::mean_over_rows(const Error& error) const {
  const double most = kAsBadAsCanBe * variance();
  double sum = 0;
  double rows = 0;
  for (const Fold& fold : folds_) {
    const auto own = static_cast<double>(fold.target.size());
    sum += own * std::min(error(fold), most);
    rows += own;
  }
  return sum / rows;
}

double SearchValidation::mean_square() const {
  return mean_over_rows([](const Fold& fold) { return fold.mean_square[fold.chosen]; });
}

int SearchValidation::bound(std::span<const Expression> front, std::size_t chosen) const {
  std::vector<double> within;
  for (const Expression& formula : front) {
    const int complexity = paper_complexity(formula);
    within.push_back(
        mean_over_rows([complexity](const Fold& fold) { return fold.up_to(complexity); }));
  }
  const int as_good = paper_complexity(front[simplest_as_good(within)]);
  const bool stands = mean_square() <= std::min(kClearly * std::ranges::min(within), variance());
  return stands ? std::max(as_good, paper_complexity(front[chosen])) : as_good;
}

std::size_t most_typical(std::span<const Expression> candidates,
                         std::span<const Expression> searched, const Inputs& inputs) {
  const auto values_of = [&inputs](const Expression& formula) {
    std::vector<double> values(inputs.rows);
    Evaluator().evaluate(formula, inputs, values);
    return values;
  };
  std::vector<std::vector<double>> said;
  for (const Expression& formula : searched) said.push_back(values_of(formula));
  std::vector<std::optional<double>> middle(inputs.rows);
  std::vector<double> at_row;
  for (std::size_t row = 0; row < inputs.rows; ++row) {
    at_row.clear();
    for (const std::vector<double>& one : said) {
      if (std::isfinite(one[row])) at_row.push_back(one[row]);
    }
    if (!at_row.empty()) middle[row] = median(at_row);
  }
  std::vector<double> distance;
  for (const Expression& formula : candidates) {
    const std::vector<double> values = values_of(formula);
    double sum = 0;
    for (std::size_t row = 0; row < inputs.rows; ++row) {
      if (middle[row]) sum += (values[row] - *middle[row]) * (values[row] - *middle[row]);
    }
    distance.push_back(std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity());
  }
  return static_cast<std::size_t>(std::ranges::min_element(distance) - distance.begin());
}

}  // namespace tribench
