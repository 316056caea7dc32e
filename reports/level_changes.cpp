// SPDX-License-Identifier: MIT
#include "reports/level_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

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

std::vector<double> about_one(std::span<const double> weights) {
  double mean = 0;
  for (const double weight : weights) mean += weight / static_cast<double>(weights.size());
  std::vector<double> result;
  for (const double weight : weights) result.push_back(weight / mean);
  return result;
}

// Of a value of weight 1: neighbours differ by what both are unsure of.
double noise_variance(std::span<const double> values, std::span<const double> weights,
                      double least_noise) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    steps.push_back(std::abs(values[i] - values[i - 1]) /
                    std::sqrt(1 / weights[i] + 1 / weights[i - 1]));
  }
  const double deviation = std::max(kMadToSd * median(steps), least_noise);
  return deviation * deviation;
}

// One over each value's variance.
std::vector<double> precisions(std::span<const double> values, std::span<const double> weights,
                               double least_noise) {
  std::vector<double> result = about_one(weights);
  const double variance = noise_variance(values, result, least_noise);
  for (double& weight : result) weight /= variance;
  return result;
}

// Where a level may end: everywhere in a series of a year, at every k-th place from the end of
// a longer one.
std::vector<std::size_t> places_of(std::size_t n, std::size_t step) {
  std::vector<std::size_t> places;
  for (std::size_t place = n; place >= step; place -= step) places.push_back(place);
  if (places.back() != 0) places.push_back(0);
  std::ranges::reverse(places);
  return places;
}

// And then everywhere near the ends that were found so.
std::vector<std::size_t> places_near(const std::vector<std::size_t>& ends, std::size_t step) {
  std::set<std::size_t> places = {0, ends.back()};
  for (const std::size_t end : ends) {
    for (std::size_t place = end - std::min(end, 2 * step); place <= end + 2 * step; ++place) {
      if (place < ends.back()) places.insert(place);
    }
  }
  return {places.begin(), places.end()};
}

// The ends of the levels of the least cost with a penalty for each.
std::vector<std::size_t> partition(const Segments& segments, const std::vector<std::size_t>& places,
                                   double penalty) {
  const std::size_t m = places.size();
  std::vector<double> best(m, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(m, 0);
  best[0] = -penalty;
  std::vector<std::size_t> candidates;
  std::vector<double> costs;
  std::size_t next = 0;  // the first place that is no candidate yet
  for (std::size_t end = 1; end < m; ++end) {
    while (places[next] + kShortest <= places[end]) {
      if (best[next] < std::numeric_limits<double>::infinity()) candidates.push_back(next);
      ++next;
    }
    costs.clear();
    for (const std::size_t begin : candidates) {
      costs.push_back(best[begin] + segments.cost(places[begin], places[end]));
      if (costs.back() + penalty < best[end]) {
        best[end] = costs.back() + penalty;
        from[end] = begin;
      }
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (costs[k] <= best[end]) candidates[kept++] = candidates[k];
    }
    candidates.resize(kept);
  }
  std::vector<std::size_t> ends;
  for (std::size_t end = m - 1; end > 0; end = from[end]) ends.push_back(places[end]);
  std::ranges::reverse(ends);
  return ends;
}

}  // namespace

std::vector<LevelChange> find_level_changes(std::span<const double> values,
                                            std::span<const double> weights, double least_noise) {
  const std::size_t n = values.size();
  if (n < 2 * kShortest) return {};
  // About the first value: sums of squares lose no digits to a common level.
  std::vector<double> centred(values.begin(), values.end());
  for (double& value : centred) value -= values.front();
  const Segments segments(centred, precisions(values, weights, least_noise));
  const double penalty = 3 * elementary::log(static_cast<double>(n)) + 4;
  constexpr std::size_t kPlaces = 500;
  const std::size_t step = (n + kPlaces - 1) / kPlaces;
  std::vector<std::size_t> ends = partition(segments, places_of(n, step), penalty);
  if (step > 1) ends = partition(segments, places_near(ends, step), penalty);
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
