// SPDX-License-Identifier: MIT
#include "reports/night_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/figures.hpp"
#include "reports/statistics/permutation_shift.hpp"

namespace tribench {
namespace {

using TestKey = std::tuple<std::string, std::string, std::string>;  // method, operators, problem

// What a seed gave: figures that differ from the night's before, with the night (the base is 0).
struct Draws {
  std::vector<double> values;
  std::vector<std::size_t> nights;
};
using SeedDraws = std::map<std::uint64_t, Draws>;

// Six digits are kept: what differs by less is the same draw.
constexpr double kKept = 2e-5;

std::map<TestKey, SeedDraws> draws_of(const Night& base, std::span<const Night* const> nights) {
  std::map<TestKey, SeedDraws> all;
  const auto add = [&](const NightSeries& series, std::size_t night, SeedDraws& seeds) {
    for (const auto& [seed, value] : series.log_errors) {
      Draws& draws = seeds[seed];
      const auto figure = static_cast<double>(value);
      if (!draws.values.empty() && std::abs(draws.values.back() - figure) < kKept) continue;
      draws.values.push_back(figure);
      draws.nights.push_back(night);
    }
  };
  for (const NightSeries& series : base.series) {
    add(series, 0, all[{series.method, series.operators, series.problem}]);
  }
  for (std::size_t k = 0; k < nights.size(); ++k) {
    for (const NightSeries& series : nights[k]->series) {
      const auto found = all.find({series.method, series.operators, series.problem});
      if (found != all.end()) add(series, k + 1, found->second);
    }
  }
  return all;
}

// Distances from a seed's median in units of its noise, cut off: a search that once in a while ends
// elsewhere must not outweigh all others. A seed's noise is that of its own draws, as far as they
// tell, and the series'. Everything forgets the order of the draws.
class Scores {
 public:
  explicit Scores(const SeedDraws& seeds) {
    std::vector<double> distances;
    for (const auto& [seed, draws] : seeds) {
      if (draws.values.size() < 2) continue;
      const double middle = median(draws.values);
      for (const double value : draws.values) distances.push_back(std::abs(value - middle));
    }
    if (!distances.empty()) noise_ = std::max(kMadToSd * median(distances), kKept);
  }

  std::vector<double> of(const std::vector<double>& values) const {
    constexpr double kPrior = 4;      // draws that the series' noise counts for
    constexpr double kLargest = 2.5;  // noises
    constexpr double kWeight = 3;     // at most, of a quiet seed
    const double middle = median(values);
    std::vector<double> distances;
    for (const double value : values) distances.push_back(std::abs(value - middle));
    const auto n = static_cast<double>(values.size());
    const double own = (kPrior * noise_ + n * kMadToSd * median(distances)) / (kPrior + n);
    const double weight = std::min(kWeight, noise_ / own);
    std::vector<double> scores;
    for (const double value : values) {
      scores.push_back(weight * std::clamp((value - middle) / own, -kLargest, kLargest));
    }
    return scores;
  }

 private:
  double noise_ = kKept;
};

// The strata of a test, and each seed's own difference of means.
struct Test {
  std::vector<ShiftStratum> strata;
  std::vector<double> differences;
};

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Seeds that have a draw from before `first` and one since.
Test test_of(const SeedDraws& seeds, const Scores& scores, std::size_t first) {
  Test test;
  for (const auto& [seed, draws] : seeds) {
    const auto since = std::ranges::lower_bound(draws.nights, first);
    const auto later = static_cast<std::size_t>(draws.nights.end() - since);
    if (later == 0 || later == draws.values.size()) continue;
    test.strata.push_back({scores.of(draws.values), later});
    const std::span<const double> values(draws.values);
    test.differences.push_back(mean_of(values.last(later)) -
                               mean_of(values.first(values.size() - later)));
  }
  return test;
}

std::map<TestKey, Test> tests_of(const std::map<TestKey, SeedDraws>& all,
                                 const std::map<TestKey, Scores>& scores, std::size_t first) {
  std::map<TestKey, Test> tests;
  for (const auto& [key, seeds] : all) {
    Test test = test_of(seeds, scores.at(key), first);
    const auto& [method, operators, problem] = key;
    Test& pooled = tests[{method, operators, ""}];
    pooled.strata.insert(pooled.strata.end(), test.strata.begin(), test.strata.end());
    pooled.differences.insert(pooled.differences.end(), test.differences.begin(),
                              test.differences.end());
    tests[key] = std::move(test);
  }
  return tests;
}

std::vector<const Night*> asked_alike(const Night& base, std::span<const Night> since) {
  std::vector<const Night*> nights;
  for (const Night& night : since) {
    if (night.grid == base.grid && night.data == base.data) nights.push_back(&night);
  }
  return nights;
}

// Median over seeds of the last draw less the mean of those before; nothing where a typical seed
// has too few.
std::optional<double> last_against_all(const SeedDraws& seeds) {
  std::vector<double> differences;
  std::vector<double> before;
  for (const auto& [seed, draws] : seeds) {
    before.push_back(static_cast<double>(draws.values.size()) - 1);
    if (draws.values.size() < 2) continue;
    const std::span<const double> values(draws.values);
    differences.push_back(values.back() - mean_of(values.first(values.size() - 1)));
  }
  if (!(median(before) >= static_cast<double>(kNightsThatSettle))) return std::nullopt;
  return median(differences);
}

}  // namespace

void settle_by_nights(Comparison& comparison, const Night& base, std::span<const Night> since) {
  const std::vector<const Night*> nights = asked_alike(base, since);
  const std::map<TestKey, SeedDraws> draws = draws_of(base, nights);
  for (ComparisonRow& row : comparison.quality) {
    if (!row.undecided) continue;
    for (const auto& [key, seeds] : draws) {
      const auto& [method, operators, problem] = key;
      // A row without a problem is of a method that has but one.
      if (method != row.method || operators != row.operators ||
          (!row.problem.empty() && problem != row.problem)) {
        continue;
      }
      const std::optional<double> loss = last_against_all(seeds);
      if (loss && *loss <= elementary::log1p(comparison.tolerance)) row.undecided = false;
    }
  }
}

std::vector<NightFinding> find_losses(const Night& base, std::span<const Night> since,
                                      const NightTestOptions& options) {
  const std::vector<const Night*> nights = asked_alike(base, since);
  std::vector<NightFinding> findings;
  if (since.empty() || nights.empty() || nights.back() != &since.back()) return findings;
  const std::map<TestKey, SeedDraws> draws = draws_of(base, nights);
  std::map<TestKey, Scores> scores;
  for (const auto& [key, seeds] : draws) scores.emplace(key, Scores(seeds));
  for (const std::size_t window : options.windows) {
    if (window > nights.size()) continue;
    const std::map<TestKey, Test> tests = tests_of(draws, scores, nights.size() + 1 - window);
    const double level = options.alarms_a_year / options.nights_a_year /
                         static_cast<double>(options.windows.size() * tests.size());
    for (const auto& [key, test] : tests) {
      if (test.strata.empty()) continue;
      const double ratio = elementary::exp(median(test.differences));
      if (ratio <= 1 + options.equivalence) continue;
      const double p = permutation_shift_p(test.strata, level);
      if (p > level) continue;
      const auto& [method, operators, problem] = key;
      findings.push_back({method, operators, problem, window, test.strata.size(), ratio, p, level});
    }
  }
  std::ranges::stable_sort(findings, std::greater<>(), &NightFinding::ratio);
  return findings;
}

std::string losses_text(const std::vector<NightFinding>& findings) {
  std::string text;
  for (const NightFinding& each : findings) {
    text +=
        fmt::format("{} ({}) on {}: {:.1f} % worse {} than before ({}, p = {:.1g})\n", each.method,
                    each.operators, each.problem.empty() ? "all problems" : each.problem,
                    100 * (each.ratio - 1),
                    each.window == 1 ? std::string("this night")
                                     : fmt::format("in the last {} nights", each.window),
                    counted(each.pairs, "seed"), each.p);
  }
  return text;
}

}  // namespace tribench
