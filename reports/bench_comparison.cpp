// SPDX-License-Identifier: MIT
#include "reports/bench_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "foundation/elementary.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

const char* word_of(BenchChange::Figure figure) {
  switch (figure) {
    case BenchChange::Figure::instructions:
      return "instructions";
    case BenchChange::Figure::first_level_misses:
      return "misses of the first cache";
    case BenchChange::Figure::last_level_misses:
      return "misses of the last cache";
    default:
      return "time";
  }
}

std::string text_of(const std::vector<BenchChange>& changes) {
  const BenchChange& first = changes.front();
  std::string text = fmt::format("{}: {:.1f} % more {}", first.name, 100 * (first.ratio - 1),
                                 word_of(first.figure));
  if (changes.size() > 1) text += fmt::format(" and {} more", changes.size() - 1);
  return text;
}

void compare_counts(const NightBench& before, const NightBench& now,
                    const BenchThresholds& thresholds, BenchComparison& comparison) {
  const double ratio = now.instructions / before.instructions;
  if (ratio > 1 + thresholds.instructions) {
    comparison.worse.push_back({BenchChange::Figure::instructions, now.name, ratio});
  } else if (ratio < 1 / (1 + thresholds.instructions)) {
    ++comparison.better;
  }
  const auto misses = [&](BenchChange::Figure figure, double old_count, double new_count) {
    if (new_count - old_count < thresholds.least_misses ||
        new_count <= old_count * (1 + thresholds.misses)) {
      return;
    }
    comparison.worse.push_back({figure, now.name, new_count / std::max(1.0, old_count)});
  };
  misses(BenchChange::Figure::first_level_misses, before.first_level_misses,
         now.first_level_misses);
  misses(BenchChange::Figure::last_level_misses, before.last_level_misses, now.last_level_misses);
}

void compare_time(const NightBench& before, const NightBench& now,
                  const BenchThresholds& thresholds, BenchComparison& comparison) {
  const double ratio = now.time / before.time;
  const double noise =
      std::sqrt(before.time_spread * before.time_spread + now.time_spread * now.time_spread);
  if (ratio > 1 + thresholds.time && elementary::log(ratio) > thresholds.time_spreads * noise) {
    comparison.slower.push_back({BenchChange::Figure::time, now.name, ratio});
  }
}

}  // namespace

std::string BenchComparison::sentence() const {
  if (is_first) return fmt::format("benches: {} cases, the base has none to compare with", cases);
  if (!was_asked) return {};
  std::string text = fmt::format("benches: {} cases", cases);
  if (!why_not_counted.empty()) text += fmt::format(", not compared: {}", why_not_counted);
  if (why_not_counted.empty()) {
    text += worse.empty() ? std::string(", none dearer") : ", dearer: " + text_of(worse);
    if (better > 0) text += fmt::format(", {} cheaper", better);
  }
  if (!slower.empty()) text += fmt::format("; by the clock alone: {}", text_of(slower));
  if (!gone.empty()) text += fmt::format("; gone: {} ({})", gone.size(), gone.front());
  return text;
}

std::string bench_table(const BenchComparison& comparison) {
  if (comparison.worse.empty() && comparison.slower.empty()) return {};
  MarkdownTable table({{"bench"}, {"figure"}, {"now / base", Align::right}});
  for (const auto* changes : {&comparison.worse, &comparison.slower}) {
    for (const BenchChange& each : *changes) {
      table.add({each.name, word_of(each.figure), figure(each.ratio, 4)});
    }
  }
  return "\n### Benches\n\n" + table.text();
}

BenchComparison compare_benches(const Night& base, const Night& now,
                                const BenchThresholds& thresholds) {
  BenchComparison comparison;
  comparison.was_asked = !base.benches.empty() && !now.benches.empty();
  comparison.is_first = base.benches.empty() && !now.benches.empty();
  if (comparison.is_first) comparison.cases = now.benches.size();
  if (!comparison.was_asked) return comparison;
  if (base.bench_conditions != now.bench_conditions) {
    comparison.why_not_counted =
        fmt::format("{} then, {} now", base.bench_conditions, now.bench_conditions);
  } else if (base.machine != now.machine) {
    comparison.why_not_counted = "the CPUs differ";
  }
  std::map<std::string, const NightBench*> by_name;
  for (const NightBench& bench : now.benches) by_name[bench.name] = &bench;
  for (const NightBench& before : base.benches) {
    const auto found = by_name.find(before.name);
    if (found == by_name.end()) {
      comparison.gone.push_back(before.name);
      continue;
    }
    ++comparison.cases;
    if (comparison.why_not_counted.empty()) {
      compare_counts(before, *found->second, thresholds, comparison);
      compare_time(before, *found->second, thresholds, comparison);
    }
  }
  for (auto* changes : {&comparison.worse, &comparison.slower}) {
    std::ranges::stable_sort(*changes, std::greater<>(), &BenchChange::ratio);
  }
  return comparison;
}

}  // namespace tribench
