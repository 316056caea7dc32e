// SPDX-License-Identifier: MIT
//
// Intervals: how sure a figure is. Every random draw comes from the stream handed in. Not for
// whether two things differ: paired tests (rank_tests.hpp) see what two intervals side by side do
// not.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {

inline constexpr double kConfidence = 0.95;  // of what a report prints

struct ConfidenceInterval {
  double low = 0;
  double high = 0;
  bool contains(double value) const { return low <= value && value <= high; }
};

// For `hits` of `trials` at the given confidence; Wilson 1927. [0, 1] without trials.
ConfidenceInterval wilson(std::size_t hits, std::size_t trials, double confidence);
// For the mean of `trials` shares (of recovered seeds, a problem each): hits may be parts of one.
// No values in [0, 1] with that mean vary more than hits and misses, so that it is wide enough, and
// it has a width where all are 0 or all are 1, as a bootstrap has not.
ConfidenceInterval wilson_of_share(double share, std::size_t trials, double confidence);

// For the median of what the values are drawn from: from the k-th smallest to the k-th largest,
// with the largest k that keeps the confidence whatever the distribution (Conover 1999, section
// 3.2). NaN where there are too few values: fewer than six at 95 %. Values hold no NaN.
ConfidenceInterval median_interval(std::span<const double> values, double confidence);

// Percentile bootstrap with `rounds` resamples of the values (Efron 1979); `statistic` sees each
// resample. Values hold no NaN; with none the interval is NaN. Cost: rounds x statistic.
ConfidenceInterval bootstrap(std::span<const double> values,
                             const std::function<double(std::span<const double>)>& statistic,
                             double confidence, std::size_t rounds, const RandomStream& random);

// Two levels: groups (problems) are resampled, then values (seeds) within each drawn group; the
// statistic sees all drawn values. Davison, Hinkley 1997, section 3.8.
ConfidenceInterval two_level_bootstrap(
    const std::vector<std::vector<double>>& groups,
    const std::function<double(std::span<const double>)>& statistic, double confidence,
    std::size_t rounds, const RandomStream& random);

}  // namespace tribench
