// SPDX-License-Identifier: MIT
#include "reports/statistics/rank_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "foundation/order_statistics.hpp"
#include "reports/statistics/distributions.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMaxExactPairs = 60;

// P(W <= w) over all sign patterns, for ranks that may be halves (hence doubled to integers).
double exact_lower_tail(const std::vector<double>& ranks, double w) {
  std::size_t total = 0;
  for (const double rank : ranks) total += static_cast<std::size_t>(std::lround(2 * rank));
  std::vector<double> chance(total + 1, 0.0);
  chance[0] = 1;
  std::size_t reached = 0;
  for (const double rank : ranks) {
    const auto doubled = static_cast<std::size_t>(std::lround(2 * rank));
    reached += doubled;
    for (std::size_t s = reached + 1; s-- > 0;) {
      const double with = s >= doubled ? chance[s - doubled] : 0.0;
      chance[s] = (chance[s] + with) / 2;
    }
  }
  const auto limit = static_cast<std::size_t>(std::lround(2 * w));
  return std::accumulate(chance.begin(), chance.begin() + static_cast<std::ptrdiff_t>(limit + 1),
                         0.0);
}

// Sum of t^3 - t over groups of equal ranks.
double tie_term(std::vector<double> ranks) {
  std::sort(ranks.begin(), ranks.end());
  double sum = 0;
  for (std::size_t i = 0; i < ranks.size();) {
    std::size_t end = i;
    while (end < ranks.size() && ranks[end] == ranks[i]) ++end;
    const auto t = static_cast<double>(end - i);
    sum += t * t * t - t;
    i = end;
  }
  return sum;
}

double approximate_p(const std::vector<double>& ranks, double smaller_sum) {
  const auto n = static_cast<double>(ranks.size());
  const double mean = n * (n + 1) / 4;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - tie_term(ranks) / 48;
  const double z = (smaller_sum + 0.5 - mean) / std::sqrt(variance);
  return std::min(1.0, 2 * normal_cdf(z));
}

}  // namespace

SignedRankTest wilcoxon_signed_rank(std::span<const double> differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (std::isnan(difference) || difference == 0) continue;
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0);
  }
  SignedRankTest test;
  test.pairs = sizes.size();
  if (sizes.empty()) return test;
  const std::vector<double> ranks = ranks_of(sizes);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    (positive[i] ? test.rank_sum_positive : test.rank_sum_negative) += ranks[i];
  }
  const double smaller = std::min(test.rank_sum_positive, test.rank_sum_negative);
  test.exact = test.pairs <= kMaxExactPairs;
  test.p = test.exact ? std::min(1.0, 2 * exact_lower_tail(ranks, smaller))
                      : approximate_p(ranks, smaller);
  test.effect = (test.rank_sum_positive - test.rank_sum_negative) /
                (test.rank_sum_positive + test.rank_sum_negative);
  return test;
}

double smallest_signed_rank_p(std::size_t pairs) {
  return pairs == 0 ? 1.0 : std::min(1.0, std::ldexp(2.0, -static_cast<int>(pairs)));
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    if (!std::isnan(p_values[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.begin(), p_values.end());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double scaled = static_cast<double>(order.size() - i) * p_values[order[i]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

FriedmanTest friedman(std::span<const double> values, std::size_t treatments, double level) {
  FriedmanTest test;
  test.treatments = treatments;
  test.blocks = treatments == 0 ? 0 : values.size() / treatments;
  test.mean_ranks.assign(treatments, 0.0);
  test.critical_difference = std::numeric_limits<double>::infinity();
  if (test.blocks == 0) return test;
  double ties = 0;
  for (std::size_t b = 0; b < test.blocks; ++b) {
    const std::vector<double> ranks = ranks_of(values.subspan(b * treatments, treatments));
    for (std::size_t t = 0; t < treatments; ++t) test.mean_ranks[t] += ranks[t];
    ties += tie_term(ranks);
  }
  const auto n = static_cast<double>(test.blocks);
  const auto k = static_cast<double>(treatments);
  for (double& rank : test.mean_ranks) rank /= n;
  if (test.blocks < 2 || treatments < 2) return test;
  double squares = 0;
  for (const double rank : test.mean_ranks) squares += (rank - (k + 1) / 2) * (rank - (k + 1) / 2);
  const double correction = 1 - ties / (n * k * (k * k - 1));
  test.chi_squared = correction > 0 ? 12 * n / (k * (k + 1)) * squares / correction : 0.0;
  test.p = chi_squared_tail(test.chi_squared, k - 1);
  test.critical_difference = normal_range_quantile(1 - level, static_cast<int>(treatments)) /
                             std::numbers::sqrt2 * std::sqrt(k * (k + 1) / (6 * n));
  return test;
}

double kendall_tau(std::span<const double> a, std::span<const double> b) {
  const auto sign = [](double x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); };
  long concordance = 0;
  long told_by_a = 0;
  long told_by_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int in_a = sign(a[i] - a[j]);
      const int in_b = sign(b[i] - b[j]);
      concordance += in_a * in_b;
      told_by_a += in_a * in_a;
      told_by_b += in_b * in_b;
    }
  }
  if (told_by_a == 0 && told_by_b == 0) return 1;
  if (told_by_a == 0 || told_by_b == 0) return 0;
  return static_cast<double>(concordance) /
         std::sqrt(static_cast<double>(told_by_a) * static_cast<double>(told_by_b));
}

}  // namespace tribench
