// SPDX-License-Identifier: MIT
#include "algorithms/fitting/exact_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/shape_dimension.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kAlike = 100;
constexpr double kExactEnough = 1e-9;
constexpr double kEpsilon = 1e-16;
constexpr double kBulk = 0.9;          // the share of the rows that lie nearest to the median
constexpr double kExactInBulk = 1e-5;  // of their spread

double spread_of(std::span<const double> target) {
  const auto n = static_cast<double>(target.size());
  double mean = 0;
  for (const double y : target) mean += y / n;
  double square = 0;
  for (const double y : target) square += (y - mean) * (y - mean);
  return square;
}

// Rows near the median: where a few rows hold nearly all of the spread, a formula that meets those
// alone is no law.
class Bulk {
 public:
  explicit Bulk(std::span<const double> target) : target_(target) {
    const auto at = [](std::vector<double> values, double share) {
      const auto place =
          static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
      std::ranges::nth_element(values, values.begin() + place);
      return values[static_cast<std::size_t>(place)];
    };
    median_ = at({target.begin(), target.end()}, 0.5);
    std::vector<double> sizes;
    for (const double y : target) sizes.push_back(std::abs(y - median_));
    bound_ = at(std::move(sizes), kBulk);
    for (const double y : target) spread_ += contains(y) ? (y - median_) * (y - median_) : 0;
  }

  bool is_met_by(std::span<const double> values) const {
    if (!(spread_ > 0)) return true;
    double left = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (contains(target_[r])) left += (values[r] - target_[r]) * (values[r] - target_[r]);
    }
    return left <= kExactInBulk * kExactInBulk * spread_;
  }

 private:
  bool contains(double y) const { return std::abs(y - median_) <= bound_; }

  std::span<const double> target_;
  double median_ = 0;
  double bound_ = 0;
  double spread_ = 0;
};

// Whether the rows beyond those that a formula's numbers could meet by themselves say more than it
// took to find its form: each of them is met to `error` of the spread, and each node is one of
// all symbols. On a dozen rows any long form is exact once it has as many numbers.
bool is_more_than_met(const Expression& formula, const Inputs& inputs, double error) {
  const std::size_t numbers = shape_dimension(formula) + free_exponents(formula);
  if (numbers >= inputs.rows) return false;
  const double symbols = kOpCount - 1 + static_cast<double>(inputs.columns.size());
  return static_cast<double>(inputs.rows - numbers) * -elementary::log(std::max(error, kEpsilon)) >
         static_cast<double>(node_count(formula)) * elementary::log(symbols);
}

}  // namespace

std::optional<std::size_t> simplest_exact(std::span<const Expression> formulas,
                                          const Inputs& inputs, std::span<const double> target) {
  if (formulas.empty() || target.empty()) return std::nullopt;
  const double spread = spread_of(target);
  if (!(spread > 0)) return std::nullopt;
  const Bulk bulk(target);
  Evaluator evaluator;
  std::vector<double> errors;
  std::vector<double> values(target.size());
  for (const Expression& formula : formulas) {
    const ErrorSum sum = evaluator.sum_squared_errors(formula, inputs, target);
    errors.push_back(sum.status == ErrorSumStatus::complete ? std::sqrt(sum.sum / spread)
                                                            : HUGE_VAL);
    if (!(errors.back() <= kNearlyExact)) continue;
    evaluator.evaluate(formula, inputs, values);
    if (!bulk.is_met_by(values) || !is_more_than_met(formula, inputs, errors.back())) {
      errors.back() = HUGE_VAL;
    }
  }
  const double best = std::ranges::min(errors);
  if (!(best <= kNearlyExact)) return std::nullopt;
  const double enough = std::max(kAlike * best, kExactEnough);
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
