// SPDX-License-Identifier: MIT
#include "algorithms/inference/gamma_tail.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/incomplete_gamma.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kKnots = 96;

}  // namespace

MatchedGamma::MatchedGamma(double mean, double variance) {
  if (!(mean > 0) || !(variance > 0)) return;
  shape_ = mean * mean / variance;
  scale_ = variance / mean;
}

double MatchedGamma::score(double statistic) const {
  if (!(shape_ > 0)) return 0;
  return -log_gamma_upper_tail(shape_, statistic / scale_) / std::numbers::ln10;
}

double MatchedGamma::statistic_of(double wanted) const {
  if (!(shape_ > 0)) return 0;
  constexpr int kHalvings = 60;
  double low = 0;
  double high = scale_ * (shape_ + 1);
  while (score(high) < wanted) high *= 2;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (score(middle) < wanted ? low : high) = middle;
  }
  return high;
}

void MatchedGamma::tabulate(double largest) {
  table_.clear();
  if (!(shape_ > 0) || !(largest > 0)) return;
  // Even steps of the square root: the score grows like the statistic, its curvature sits at 0.
  step_ = std::sqrt(largest) / static_cast<double>(kKnots - 1);
  inverse_step_ = 1 / step_;
  table_.assign(kKnots, std::numeric_limits<double>::quiet_NaN());
}

double MatchedGamma::knot(std::size_t k) {
  if (std::isnan(table_[k])) {
    const auto at = static_cast<double>(k);
    table_[k] = score(step_ * at * step_ * at);
  }
  return table_[k];
}

double MatchedGamma::none_below(double wanted) {
  if (table_.empty()) return 0;
  std::size_t low = 0;  // a knot with less, but for the first
  std::size_t high = table_.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (knot(middle) < wanted ? low : high) = middle;
  }
  const double root = step_ * static_cast<double>(low);
  return root * root;
}

double MatchedGamma::fast_score(double statistic) {
  if (table_.empty()) return score(statistic);
  const double place = std::sqrt(statistic) * inverse_step_;
  // Also of NaN, which is no place in a table.
  if (!(place < static_cast<double>(table_.size() - 1))) return score(statistic);
  const auto below = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(below);
  const double low = knot(below);
  return low + part * (knot(below + 1) - low);
}

}  // namespace tribench::loop
