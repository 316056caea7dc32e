// SPDX-License-Identifier: MIT
#include "foundation/order_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tribench {
namespace {

std::vector<double> sorted_without_nan(std::span<const double> values) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return !std::isnan(value); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double quantile_of_sorted(const std::vector<double>& sorted, double level) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = level * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double fraction = place - static_cast<double>(below);
  // Infinite neighbours must not meet in a subtraction.
  if (fraction == 0 || below + 1 == sorted.size()) return sorted[below];
  if (sorted[below] == sorted[below + 1]) return sorted[below];
  return sorted[below] * (1 - fraction) + sorted[below + 1] * fraction;
}

}  // namespace

double quantile(std::span<const double> values, double level) {
  return quantile_of_sorted(sorted_without_nan(values), level);
}

double upper_median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double upper_median_magnitude(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return upper_median(std::move(values));
}

Spread spread_of(std::span<const double> values) {
  const std::vector<double> sorted = sorted_without_nan(values);
  return {sorted.size(),
          quantile_of_sorted(sorted, 0),
          quantile_of_sorted(sorted, 0.25),
          quantile_of_sorted(sorted, 0.5),
          quantile_of_sorted(sorted, 0.75),
          quantile_of_sorted(sorted, 1)};
}

std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    const double mean_rank = static_cast<double>(i + 1 + end) / 2;
    for (; i < end; ++i) ranks[order[i]] = mean_rank;
  }
  return ranks;
}

}  // namespace tribench
