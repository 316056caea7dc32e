// SPDX-License-Identifier: MIT
#include "reports/statistics/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/statistics/distributions.hpp"

namespace tribench {
namespace {

ConfidenceInterval percentile_interval(const std::vector<double>& estimates, double confidence) {
  const double tail = (1 - confidence) / 2;
  return {quantile(estimates, tail), quantile(estimates, 1 - tail)};
}

constexpr ConfidenceInterval kNone{std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::quiet_NaN()};

}  // namespace

ConfidenceInterval wilson(std::size_t hits, std::size_t trials, double confidence) {
  const double share = trials == 0 ? 0 : static_cast<double>(hits) / static_cast<double>(trials);
  return wilson_of_share(share, trials, confidence);
}

ConfidenceInterval wilson_of_share(double share, std::size_t trials, double confidence) {
  if (trials == 0) return {0, 1};
  const auto n = static_cast<double>(trials);
  const double z = normal_quantile(0.5 + confidence / 2);
  const double centre = share + z * z / (2 * n);
  const double half = z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  return {std::max(0.0, (centre - half) / scale), std::min(1.0, (centre + half) / scale)};
}

ConfidenceInterval median_interval(std::span<const double> values, double confidence) {
  const std::size_t n = values.size();
  const auto size = static_cast<double>(n);
  // Chance that fewer than k + 1 of the values lie below the median.
  double below = 0;
  std::size_t k = 0;
  for (; k < n; ++k) {
    const auto hits = static_cast<double>(k);
    below += elementary::exp(elementary::lgamma(size + 1) - elementary::lgamma(hits + 1) -
                             elementary::lgamma(size - hits + 1) - size * elementary::log(2.0));
    if (below > (1 - confidence) / 2) break;
  }
  if (k == 0) return kNone;
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  return {sorted[k - 1], sorted[n - k]};
}

ConfidenceInterval bootstrap(std::span<const double> values,
                             const std::function<double(std::span<const double>)>& statistic,
                             double confidence, std::size_t rounds, const RandomStream& random) {
  return two_level_bootstrap({{values.begin(), values.end()}}, statistic, confidence, rounds,
                             random);
}

ConfidenceInterval two_level_bootstrap(
    const std::vector<std::vector<double>>& groups,
    const std::function<double(std::span<const double>)>& statistic, double confidence,
    std::size_t rounds, const RandomStream& random) {
  std::vector<const std::vector<double>*> filled;
  for (const auto& group : groups) {
    if (!group.empty()) filled.push_back(&group);
  }
  if (filled.empty()) return kNone;
  std::vector<double> estimates(rounds);
  std::vector<double> drawn;
  for (std::size_t round = 0; round < rounds; ++round) {
    RandomStream stream = random.split(round);
    drawn.clear();
    for (std::size_t g = 0; g < filled.size(); ++g) {
      const std::vector<double>& group = *filled[stream.below(filled.size())];
      for (std::size_t i = 0; i < group.size(); ++i) {
        drawn.push_back(group[stream.below(group.size())]);
      }
    }
    estimates[round] = statistic(drawn);
  }
  return percentile_interval(estimates, confidence);
}

}  // namespace tribench
