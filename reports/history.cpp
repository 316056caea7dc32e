// SPDX-License-Identifier: MIT
#include "reports/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/statistics/rank_tests.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewest = 6;
constexpr std::size_t kAtLeast = 2;  // runs on either side of a step

struct Split {
  std::size_t at = 0;
  double statistic = 0;
};

double mean_of(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = values.begin() + static_cast<std::ptrdiff_t>(end);
  return std::accumulate(first, last, 0.0) / static_cast<double>(end - begin);
}

Split best_split(const std::vector<double>& series) {
  const auto n = static_cast<double>(series.size());
  const double total = std::accumulate(series.begin(), series.end(), 0.0);
  Split best;
  double sum = 0;
  for (std::size_t k = 1; k + kAtLeast <= series.size(); ++k) {
    sum += series[k - 1];
    if (k < kAtLeast) continue;
    const auto left = static_cast<double>(k);
    const double difference = (total - sum) / (n - left) - sum / left;
    const double statistic = std::abs(difference) * std::sqrt(left * (n - left) / n);
    if (statistic > best.statistic) best = {k, statistic};
  }
  return best;
}

double kendall(const std::vector<double>& series) {
  double sum = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    for (std::size_t j = i + 1; j < series.size(); ++j) {
      sum += series[j] > series[i] ? 1 : (series[j] < series[i] ? -1 : 0);
    }
  }
  return std::abs(sum);
}

// Median of the slopes of all pairs (Theil 1950, Sen 1968).
double theil_sen(const std::vector<double>& series) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < series.size(); ++i) {
    for (std::size_t j = i + 1; j < series.size(); ++j) {
      slopes.push_back((series[j] - series[i]) / static_cast<double>(j - i));
    }
  }
  return median(slopes);
}

double rest_of_step(const std::vector<double>& series, std::size_t at) {
  const double left = mean_of(series, 0, at);
  const double right = mean_of(series, at, series.size());
  double rest = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double off = series[i] - (i < at ? left : right);
    rest += off * off;
  }
  return rest;
}

double rest_of_line(const std::vector<double>& series, double slope) {
  std::vector<double> level;
  for (std::size_t i = 0; i < series.size(); ++i) {
    level.push_back(series[i] - slope * static_cast<double>(i));
  }
  const double middle = mean_of(level, 0, level.size());
  double rest = 0;
  for (const double value : level) rest += (value - middle) * (value - middle);
  return rest;
}

using SeriesKey = std::tuple<std::string, std::string, std::string>;  // method, operators, problem

std::map<SeriesKey, std::vector<double>> log_medians(const RunFolder& run) {
  std::map<SeriesKey, std::vector<double>> errors;
  for (const Record& record : run.records) {
    if (is_ok(record) && record.mae_test > 0 && std::isfinite(record.mae_test)) {
      errors[{record.method, record.operators, record.problem}].push_back(
          elementary::log(record.mae_test));
    }
  }
  for (auto& [key, values] : errors) values = {median(values)};
  return errors;
}

}  // namespace

Change find_change(const std::vector<double>& series, const HistoryOptions& options,
                   std::uint64_t key) {
  Change change;
  const Split split = best_split(series);
  if (series.size() < kFewest || split.statistic == 0) return change;
  const double tau = kendall(series);
  std::size_t steps = 1;
  std::size_t drifts = 1;
  const RandomStream random(key);
  for (std::size_t i = 0; i < options.permutations; ++i) {
    std::vector<double> shuffled = series;
    RandomStream stream = random.split(i);
    stream.shuffle(std::span<double>(shuffled));
    // Rounding must not make a permutation of equal means count as smaller.
    if (best_split(shuffled).statistic >= split.statistic * (1 - 1e-12)) ++steps;
    if (kendall(shuffled) >= tau) ++drifts;
  }
  const auto all = static_cast<double>(options.permutations + 1);
  const double slope = theil_sen(series);
  const bool is_drift = rest_of_line(series, slope) < rest_of_step(series, split.at);
  // Two looks at the same series are paid for.
  change.p = std::min(1.0, 2 * static_cast<double>(std::min(steps, drifts)) / all);
  change.kind = is_drift ? Change::Kind::drift : Change::Kind::step;
  change.at = is_drift ? 0 : split.at;
  change.ratio = is_drift ? elementary::exp(slope * static_cast<double>(series.size() - 1))
                          : elementary::exp(mean_of(series, split.at, series.size()) -
                                            mean_of(series, 0, split.at));
  return change;
}

std::vector<SeriesChange> find_changes(const std::vector<RunFolder>& runs,
                                       const HistoryOptions& options) {
  std::map<SeriesKey, std::pair<std::vector<double>, std::vector<std::size_t>>> all;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const auto& [key, values] : log_medians(runs[i])) {
      all[key].first.push_back(values.front());
      all[key].second.push_back(i);
    }
  }
  std::vector<SeriesChange> changes;
  std::vector<double> p;
  for (const auto& [key, series] : all) {
    const auto& [method, operators, problem] = key;
    Change change = find_change(series.first, options,
                                key_of(fmt::format("{}|{}|{}", method, operators, problem)));
    if (change.kind == Change::Kind::step) change.at = series.second[change.at];
    p.push_back(change.p);
    changes.push_back({method, operators, problem, change});
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i].change.p = adjusted[i];
  std::erase_if(changes, [&](const SeriesChange& each) {
    return each.change.p > options.level ||
           std::abs(elementary::log(each.change.ratio)) <= elementary::log1p(options.equivalence);
  });
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    return std::abs(elementary::log(a.change.ratio)) > std::abs(elementary::log(b.change.ratio));
  });
  return changes;
}

std::string history_markdown(const std::vector<SeriesChange>& changes,
                             const std::vector<RunFolder>& runs) {
  if (changes.empty()) return fmt::format("No step and no drift over {} runs.\n", runs.size());
  MarkdownTable table({{"method"},
                       {"operators"},
                       {"problem"},
                       {"change"},
                       {"since"},
                       {"error now / before", Align::right},
                       {"p", Align::right}});
  for (const SeriesChange& each : changes) {
    const bool step = each.change.kind == Change::Kind::step;
    table.add({each.method, each.operators, each.problem, step ? "step" : "drift",
               step ? runs[each.change.at].path.filename().string() : "the first run",
               figure(each.change.ratio, 4), figure(each.change.p, 2)});
  }
  return table.text();
}

}  // namespace tribench
