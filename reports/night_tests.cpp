// SPDX-License-Identifier: MIT
#include "reports/night_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

using TestKey = std::tuple<std::string, std::string, std::string>;  // method, operators, problem
using Tests = std::map<TestKey, std::vector<double>>;               // differences, one a seed

// Sum of the log errors of a window and in how many nights a seed has one.
using SeedSums = std::unordered_map<std::uint64_t, std::pair<double, std::size_t>>;

std::map<std::string, SeedSums> sums_of(std::span<const Night* const> window) {
  std::map<std::string, SeedSums> sums;
  for (const Night* night : window) {
    for (const NightSeries& series : night->series) {
      SeedSums& seeds = sums[series.key()];
      for (const auto& [seed, value] : series.log_errors) {
        auto& [sum, count] = seeds[seed];
        sum += static_cast<double>(value);
        ++count;
      }
    }
  }
  return sums;
}

Tests differences(const Night& base, std::span<const Night* const> window) {
  const std::map<std::string, SeedSums> sums = sums_of(window);
  Tests tests;
  for (const NightSeries& series : base.series) {
    const auto found = sums.find(series.key());
    if (found == sums.end()) continue;
    for (const auto& [seed, before] : series.log_errors) {
      const auto now = found->second.find(seed);
      // A seed that failed in one of the nights is told by the counts of failures.
      if (now == found->second.end() || now->second.second != window.size()) continue;
      const double difference =
          now->second.first / static_cast<double>(window.size()) - static_cast<double>(before);
      tests[{series.method, series.operators, series.problem}].push_back(difference);
      tests[{series.method, series.operators, ""}].push_back(difference);
    }
  }
  return tests;
}

// Six digits are kept: what differs by less is equal.
void round_away(std::vector<double>& values) {
  constexpr double kKept = 2e-5;
  for (double& value : values) {
    if (std::abs(value) < kKept) value = 0;
  }
}

}  // namespace

std::vector<NightFinding> find_losses(const Night& base, std::span<const Night> since,
                                      const NightTestOptions& options) {
  std::vector<const Night*> nights;
  for (const Night& night : since) {
    if (night.grid == base.grid && night.data == base.data) nights.push_back(&night);
  }
  std::vector<NightFinding> findings;
  if (since.empty() || nights.empty() || nights.back() != &since.back()) return findings;
  for (const std::size_t window : options.windows) {
    if (window > nights.size()) continue;
    Tests tests = differences(base, std::span(nights).last(window));
    const double level = options.alarms_a_year / options.nights_a_year /
                         static_cast<double>(options.windows.size() * tests.size());
    for (auto& [key, values] : tests) {
      round_away(values);
      const double ratio = elementary::exp(median(values));
      if (ratio <= 1 + options.equivalence) continue;
      const SignedRankTest test = wilcoxon_signed_rank(values);
      if (test.p > level) continue;
      const auto& [method, operators, problem] = key;
      findings.push_back({method, operators, problem, window, values.size(), ratio, test.p, level});
    }
  }
  std::ranges::stable_sort(findings, std::greater<>(), &NightFinding::ratio);
  return findings;
}

std::string losses_text(const std::vector<NightFinding>& findings) {
  std::string text;
  for (const NightFinding& each : findings) {
    text +=
        fmt::format("{} ({}) on {}: {:.1f} % worse than the base over {} ({} pairs, p = {:.1g})\n",
                    each.method, each.operators,
                    each.problem.empty() ? "all problems" : each.problem, 100 * (each.ratio - 1),
                    each.window == 1 ? std::string("this night")
                                     : fmt::format("the last {} nights", each.window),
                    each.pairs, each.p);
  }
  return text;
}

}  // namespace tribench
