// SPDX-License-Identifier: MIT
#include "reports/statistics/power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reports/statistics/distributions.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

constexpr std::size_t kExactPairs = 60;

// The largest rank sum whose two-sided p is at most `level`; one there must be.
std::size_t critical_rank_sum(std::size_t pairs, double level) {
  const std::size_t most = pairs * (pairs + 1) / 2;
  if (pairs > kExactPairs) {
    const auto n = static_cast<double>(pairs);
    const double spread = std::sqrt(n * (n + 1) * (2 * n + 1) / 24);
    const double sum = n * (n + 1) / 4 + normal_quantile(level / 2) * spread - 0.5;
    return static_cast<std::size_t>(std::max(0.0, std::floor(sum)));
  }
  std::vector<double> share(most + 1, 0);
  share[0] = 1;
  for (std::size_t rank = 1; rank <= pairs; ++rank) {
    for (std::size_t sum = most + 1; sum-- > 0;) {
      share[sum] = 0.5 * (share[sum] + (sum >= rank ? share[sum - rank] : 0));
    }
  }
  double p = 0;
  std::size_t sum = 0;
  while (sum <= most && 2 * (p + share[sum]) <= level) p += share[sum++];
  return sum - 1;
}

}  // namespace

double smallest_seen_shift(std::span<const double> differences, double level) {
  std::vector<double> values;
  for (const double value : differences) {
    if (std::isfinite(value)) values.push_back(value);
  }
  const std::size_t n = values.size();
  if (n == 0 || smallest_signed_rank_p(n) > level) return std::numeric_limits<double>::infinity();
  std::vector<double> means;
  means.reserve(n * (n + 1) / 2);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) means.push_back(0.5 * (values[i] + values[j]));
  }
  const std::size_t outside = critical_rank_sum(n, level);
  std::ranges::sort(means);
  const double half = 0.5 * (means[means.size() - 1 - outside] - means[outside]);
  const double z = -normal_quantile(level / 2);
  const double larger = 1.04 + 0.4 / static_cast<double>(n);
  return half * larger * (z + normal_quantile(0.8)) / z;
}

}  // namespace tribench
