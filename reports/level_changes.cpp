// SPDX-License-Identifier: MIT
#include "reports/level_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

constexpr std::size_t kShortest = 3;

// Weighted sums up to each place: any segment's cost in constant time.
class Segments {
 public:
  Segments(std::span<const double> values, std::span<const double> weights)
      : weight_(values.size() + 1), first_(values.size() + 1), second_(values.size() + 1) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      weight_[i + 1] = weight_[i] + weights[i];
      first_[i + 1] = first_[i] + weights[i] * values[i];
      second_[i + 1] = second_[i] + weights[i] * values[i] * values[i];
    }
  }
  double mean(std::size_t begin, std::size_t end) const {
    return (first_[end] - first_[begin]) / (weight_[end] - weight_[begin]);
  }
  double cost(std::size_t begin, std::size_t end) const {
    const double sum = first_[end] - first_[begin];
    return std::max(0.0,
                    second_[end] - second_[begin] - sum * sum / (weight_[end] - weight_[begin]));
  }

 private:
  std::vector<double> weight_;
  std::vector<double> first_;
  std::vector<double> second_;
};

double noise_variance(std::span<const double> values, double least_noise) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    steps.push_back(std::abs(values[i] - values[i - 1]));
  }
  const double deviation = std::max(kMadToSd * median(steps) / std::sqrt(2.0), least_noise);
  return deviation * deviation;
}

std::vector<double> scaled(std::span<const double> weights, double variance) {
  double mean = 0;
  for (const double weight : weights) mean += weight / static_cast<double>(weights.size());
  std::vector<double> result;
  for (const double weight : weights) result.push_back(weight / mean / variance);
  return result;
}

}  // namespace

std::vector<LevelChange> find_level_changes(std::span<const double> values,
                                            std::span<const double> weights, double least_noise) {
  const std::size_t n = values.size();
  if (n < 2 * kShortest) return {};
  // About the first value: sums of squares lose no digits to a common level.
  std::vector<double> centred(values.begin(), values.end());
  for (double& value : centred) value -= values.front();
  const Segments segments(centred, scaled(weights, noise_variance(values, least_noise)));
  const double penalty = 3 * elementary::log(static_cast<double>(n)) + 4;
  std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(n + 1, 0);
  best[0] = -penalty;
  std::vector<std::size_t> candidates = {0};
  for (std::size_t end = kShortest; end <= n; ++end) {
    for (const std::size_t begin : candidates) {
      if (end - begin < kShortest) continue;
      const double cost = best[begin] + segments.cost(begin, end) + penalty;
      if (cost < best[end]) {
        best[end] = cost;
        from[end] = begin;
      }
    }
    std::erase_if(candidates, [&](std::size_t begin) {
      return end - begin >= kShortest && best[begin] + segments.cost(begin, end) > best[end];
    });
    const std::size_t next = end + 1 - kShortest;
    if (next >= kShortest) candidates.push_back(next);
  }
  std::vector<std::size_t> ends;
  for (std::size_t end = n; end > 0; end = from[end]) ends.push_back(end);
  std::ranges::reverse(ends);
  std::vector<LevelChange> changes;
  std::size_t begin = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    changes.push_back({ends[k], values.front() + segments.mean(begin, ends[k]),
                       values.front() + segments.mean(ends[k], ends[k + 1])});
    begin = ends[k];
  }
  return changes;
}

}  // namespace tribench
