// SPDX-License-Identifier: MIT
#include "reports/night_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

// Lines in the making: the nights that are read one after the other hold mostly the same ones in
// the same order, so that the place of the night before is tried first.
template <typename Line>
class Lines {
 public:
  void begin_night() { next_ = 0; }
  // The line of that key, made by `make` where there is none yet.
  template <typename Make>
  Line& line(const std::string& key, Make make) {
    if (next_ >= order_.size() || keys_[order_[next_]] != key) {
      const auto [found, is_new] = places_.try_emplace(key, lines_.size());
      if (is_new) {
        lines_.push_back(make());
        keys_.push_back(key);
        order_.push_back(found->second);
      }
      next_ = found->second;
    }
    return lines_[order_[next_++]];
  }
  std::vector<Line> take_sorted() {
    std::vector<std::size_t> places = order_;
    std::ranges::sort(places, {}, [&](std::size_t k) -> const std::string& { return keys_[k]; });
    std::vector<Line> sorted;
    for (const std::size_t place : places) sorted.push_back(std::move(lines_[place]));
    return sorted;
  }

 private:
  std::vector<Line> lines_;
  std::vector<std::string> keys_;
  std::vector<std::size_t> order_;
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t next_ = 0;
};

struct WeightedSeries {
  SeriesHistory history;
  std::vector<double> seeds;    // a night's, those that gave a formula
  std::vector<double> spreads;  // of their log errors; NaN where the night does not tell
};

// How sure each night's median is: the more so the more seeds it has and the closer they lie. The
// spread of a few seeds is uncertain itself and is taken with the usual one of the line, half and
// half.
std::vector<double> weights_of(const WeightedSeries& series) {
  std::vector<double> told;
  for (const double spread : series.spreads) {
    if (spread > 0) told.push_back(spread);
  }
  if (told.empty()) return series.seeds;
  const double usual = median(told);
  std::vector<double> weights;
  for (std::size_t k = 0; k < series.seeds.size(); ++k) {
    const double own = std::isnan(series.spreads[k]) ? usual : series.spreads[k];
    weights.push_back(series.seeds[k] / (usual * usual + own * own));
  }
  return weights;
}

void add_series(const NightSeries& series, std::size_t night, Lines<WeightedSeries>& all) {
  if (!(series.median_error > 0) || std::isinf(series.median_error)) return;
  WeightedSeries& one = all.line(series.key(), [&] {
    WeightedSeries made;
    made.history.problem = series.problem;
    made.history.method = series.method;
    made.history.operators = series.operators;
    return made;
  });
  one.history.nights.push_back(night);
  one.history.log_errors.push_back(elementary::log(series.median_error));
  one.seeds.push_back(static_cast<double>(series.cells - series.failed));
  one.spreads.push_back(series.spread);
}

void add_bench(const NightBench& bench, std::size_t night, Lines<BenchHistory>& all) {
  if (!(bench.instructions > 0)) return;
  BenchHistory& one = all.line(bench.name, [&] {
    BenchHistory made;
    made.name = bench.name;
    return made;
  });
  one.nights.push_back(night);
  one.instructions.push_back(elementary::log(bench.instructions));
  one.misses.push_back(elementary::log1p(bench.last_level_misses));
  one.time.push_back(elementary::log(bench.time));
}

}  // namespace

StoreHistory read_history(const NightStore& store) {
  StoreHistory history;
  history.blessings = store.blessings();
  Lines<WeightedSeries> series;
  Lines<BenchHistory> benches;
  for (const std::string& name : store.names()) {
    try {
      history.nights.push_back(store.read(name, false));
    } catch (const Error& error) {
      history.damaged.emplace_back(error.what());
      continue;
    }
    Night& night = history.nights.back();
    const std::size_t place = history.nights.size() - 1;
    series.begin_night();
    benches.begin_night();
    for (const NightSeries& each : night.series) add_series(each, place, series);
    for (const NightBench& each : night.benches) add_bench(each, place, benches);
    night.series = {};
    night.benches = {};
  }
  for (WeightedSeries& each : series.take_sorted()) {
    each.history.changes = find_level_changes(each.history.log_errors, weights_of(each));
    history.series.push_back(std::move(each.history));
  }
  constexpr double kCountNoise = 1e-3;  // what addresses may change in a count
  for (BenchHistory& each : benches.take_sorted()) {
    const std::vector<double> weights(each.instructions.size(), 1.0);
    each.changes = find_level_changes(each.instructions, weights, kCountNoise);
    history.benches.push_back(std::move(each));
  }
  return history;
}

std::vector<HistoryChange> changes_of(const StoreHistory& history) {
  std::vector<HistoryChange> all;
  for (const SeriesHistory& series : history.series) {
    for (const LevelChange& change : series.changes) {
      all.push_back({series.nights[change.at], "error", series.problem, series.method,
                     series.operators, elementary::exp(change.after - change.before)});
    }
  }
  for (const BenchHistory& bench : history.benches) {
    for (const LevelChange& change : bench.changes) {
      all.push_back({bench.nights[change.at], "instructions", bench.name, "", "",
                     elementary::exp(change.after - change.before)});
    }
  }
  std::ranges::stable_sort(all, [](const HistoryChange& a, const HistoryChange& b) {
    if (a.night != b.night) return a.night > b.night;
    return std::abs(elementary::log(a.ratio)) > std::abs(elementary::log(b.ratio));
  });
  return all;
}

CountSpread spread_of_counts(const StoreHistory& history) {
  CountSpread widest;
  for (const BenchHistory& bench : history.benches) {
    std::map<std::string, std::vector<double>> by_commit;
    for (std::size_t k = 0; k < bench.nights.size(); ++k) {
      by_commit[history.nights[bench.nights[k]].commit].push_back(bench.instructions[k]);
    }
    for (const auto& [commit, counts] : by_commit) {
      if (counts.size() < 2) continue;
      const auto [least, most] = std::ranges::minmax(counts);
      const double spread = elementary::expm1(most - least);
      ++widest.cases;
      widest.nights = std::max(widest.nights, counts.size());
      if (widest.name.empty() || spread > widest.spread) {
        widest.spread = spread;
        widest.name = bench.name;
      }
    }
  }
  return widest;
}

namespace {

// The changes of level as a table.
std::string changes_text(const StoreHistory& history) {
  const std::vector<HistoryChange> changes = changes_of(history);
  if (changes.empty()) return "No change of level.\n";
  MarkdownTable table({{"first night"},
                       {"figure"},
                       {"problem"},
                       {"method"},
                       {"operators"},
                       {"now / before", Align::right},
                       {"commit"},
                       {"machine"}});
  for (const HistoryChange& each : changes) {
    const Night& night = history.nights[each.night];
    table.add({night.name, each.figure, each.problem, each.method, each.operators,
               figure(each.ratio, 4), night.commit, night.machine});
  }
  return "\n" + table.text();
}

}  // namespace

std::string history_text(const StoreHistory& history) {
  std::string text =
      fmt::format("{} nights, {} series", history.nights.size(), history.series.size());
  if (!history.benches.empty()) text += fmt::format(", {} benches", history.benches.size());
  if (!history.blessings.empty()) {
    const Blessing& last = history.blessings.back();
    text += fmt::format("; base {} ({})", last.night, last.reason);
  }
  text += "\n";
  for (const std::string& damage : history.damaged) text += "damaged: " + damage + "\n";
  if (const CountSpread counts = spread_of_counts(history); counts.cases > 0) {
    text +=
        fmt::format("Counts of one commit's nights ({} at most) differ by {:.4f} % at most ({})\n",
                    counts.nights, 100 * counts.spread, counts.name);
  }
  return text + changes_text(history);
}

}  // namespace tribench
