// SPDX-License-Identifier: MIT
#include "harness/study/night_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <optional>
#include <tuple>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"
#include "harness/nightly.hpp"
#include "harness/study/each_case.hpp"
#include "reports/comparison.hpp"
#include "reports/night_tests.hpp"

namespace tribench {
namespace {

constexpr std::size_t kDetectionNights[] = {1, 3, 7};
constexpr std::size_t kCreepNights[] = {3, 5, 7};
constexpr std::size_t kLongest = 7;
constexpr double kLosses[] = {0.01, 0.03, 0.05, 0.10};
constexpr double kCreep = 0.01;

// "pysr" and true for "pysr.3".
std::optional<std::string> method_of_stream(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == name.size()) return std::nullopt;
  int number = 0;
  const auto [end, error] =
      std::from_chars(name.data() + dot + 1, name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return name.substr(0, dot);
}

double spread_of_streams(const StreamSeries& series) {
  std::vector<double> distances;
  for (const auto& [seed, values] : series.log_errors) {
    const double middle = median(values);
    for (const double value : values) distances.push_back(std::abs(value - middle));
  }
  return median(distances);
}

struct PlantedLoss {
  std::size_t series = 0;
  double log_loss = 0;
};

// A night of the same code as any other but for the planted loss.
Night drawn_night(const std::vector<StreamSeries>& all, std::string name, RandomStream random,
                  const PlantedLoss& planted = {}) {
  Night night;
  night.name = std::move(name);
  night.grid = "drawn";
  night.data = "drawn";
  for (std::size_t k = 0; k < all.size(); ++k) {
    NightSeries series;
    series.problem = all[k].problem;
    series.method = all[k].method;
    series.operators = all[k].operators;
    for (const auto& [seed, values] : all[k].log_errors) {
      const double loss = k == planted.series ? planted.log_loss : 0;
      series.log_errors.emplace_back(
          seed, static_cast<float>(values[random.below(values.size())] + loss));
    }
    series.cells = series.log_errors.size();
    night.series.push_back(std::move(series));
  }
  return night;
}

// The night as the run that it would have come from.
RunFolder run_of(const Night& night) {
  RunFolder run;
  run.path = night.name;
  for (const NightSeries& series : night.series) {
    for (const auto& [seed, value] : series.log_errors) {
      Record record;
      record.cell = fmt::format("{}|{}", series.key(), seed);
      record.problem = series.problem;
      record.method = series.method;
      record.operators = series.operators;
      record.seed = seed;
      record.status = CellStatus::ok;
      record.mae_test = elementary::exp(static_cast<double>(value));
      run.records.push_back(std::move(record));
    }
  }
  return run;
}

Comparison compared(const Night& base, const Night& now) {
  ComparisonOptions options = nightly_comparison();
  options.power_rounds = 0;
  options.rounds = 100;  // the interval decides only what is called equivalent
  return compare_runs(run_of(base), run_of(now), options);
}

bool names(const StreamSeries& planted, const std::string& method, const std::string& operators,
           const std::string& problem) {
  return method == planted.method && operators == planted.operators &&
         (problem.empty() || problem == planted.problem);
}

bool is_named(const StreamSeries& planted, const Comparison& comparison) {
  return std::ranges::any_of(comparison.quality, [&](const ComparisonRow& row) {
    return row.verdict == ComparisonVerdict::worse &&
           names(planted, row.method, row.operators, row.problem);
  });
}

bool is_named(const StreamSeries& planted, const std::vector<NightFinding>& findings) {
  return std::ranges::any_of(findings, [&](const NightFinding& each) {
    return names(planted, each.method, each.operators, each.problem);
  });
}

std::span<const Night> looked_at(const std::vector<Night>& since) {
  return std::span(since).last(std::min(since.size(), kNightsLookedAt));
}

FalseAlarms ask_pairs(const std::vector<StreamSeries>& all, const NightStudyOptions& options) {
  std::atomic<std::size_t> by_comparison = 0;
  std::atomic<std::size_t> by_nights = 0;
  std::atomic<std::size_t> undecided = 0;
  for_each_case(options.pairs, options.threads, options.quiet, [&](std::size_t pair) {
    const RandomStream random = RandomStream(key_of("night study pairs")).split(pair);
    const Night base = drawn_night(all, "base", random.split(0));
    const std::vector<Night> since = {drawn_night(all, "now", random.split(1))};
    const Comparison comparison = compared(base, since.back());
    const bool tests = !find_losses(base, since, nightly_tests()).empty();
    by_comparison += comparison.has_regression() ? 1U : 0U;
    by_nights += tests ? 1U : 0U;
    const bool is_undecided = comparison.outcome() == ComparisonOutcome::undecided;
    undecided += is_undecided && !tests ? 1U : 0U;
  });
  return {options.pairs, by_comparison, by_nights,
          undecided,     options.pairs, kNightlyAlarmsAYear / kNightsAYear};
}

FalseAlarms ask_sequences(const std::vector<StreamSeries>& all, const NightStudyOptions& options) {
  std::atomic<std::size_t> by_nights = 0;
  std::atomic<std::size_t> undecided = 0;
  for_each_case(options.sequences, options.threads, options.quiet, [&](std::size_t sequence) {
    const RandomStream random = RandomStream(key_of("night study sequences")).split(sequence);
    const Night base = drawn_night(all, "base", random.split(0));
    std::vector<Night> since;
    for (std::size_t k = 1; k <= options.nights; ++k) {
      since.push_back(drawn_night(all, fmt::format("{}", k), random.split(k)));
      by_nights += find_losses(base, looked_at(since), nightly_tests()).empty() ? 0U : 1U;
    }
    Comparison comparison = compared(base, since.back());
    settle_by_nights(comparison, base, looked_at(since));
    undecided += comparison.outcome() == ComparisonOutcome::undecided ? 1U : 0U;
  });
  FalseAlarms alarms;
  alarms.asked = options.sequences * options.nights;
  alarms.by_nights = by_nights;
  alarms.undecided = undecided;
  alarms.undecided_asked = options.sequences;
  alarms.allowed_a_night = nightly_tests().alarms_a_year / kNightsAYear;
  return alarms;
}

// The first of the nights with the loss that found it; kLongest + 1 where none did.
std::size_t night_of_finding(const std::vector<StreamSeries>& all, std::size_t series,
                             const Detection& asked, const RandomStream& random) {
  const Night base = drawn_night(all, "base", random.split(0));
  std::vector<Night> since;
  for (std::size_t k = 1; k <= asked.before; ++k) {
    since.push_back(drawn_night(all, fmt::format("{}", k), random.split(k)));
  }
  for (std::size_t k = 1; k <= kLongest; ++k) {
    const double steps = asked.creep ? static_cast<double>(k) : 1.0;
    const PlantedLoss planted = {series, steps * elementary::log1p(asked.loss)};
    since.push_back(drawn_night(all, fmt::format("loss {}", k), random.split(1000 + k), planted));
    if (is_named(all[series], find_losses(base, looked_at(since), nightly_tests()))) return k;
    if (is_named(all[series], compared(base, since.back()))) return k;
  }
  return kLongest + 1;
}

Detection detect(const std::vector<StreamSeries>& all, const std::vector<std::size_t>& series,
                 Detection asked, const NightStudyOptions& options) {
  std::vector<std::size_t> found_at(options.trials);
  for_each_case(options.trials, options.threads, options.quiet, [&](std::size_t trial) {
    const RandomStream random =
        RandomStream(key_of(fmt::format("night study {} {} {} {} {}", asked.problem, asked.method,
                                        asked.loss, asked.creep, asked.before)))
            .split(trial);
    found_at[trial] = night_of_finding(all, series[trial % series.size()], asked, random);
  });
  asked.trials = options.trials;
  const auto& nights = asked.creep ? kCreepNights : kDetectionNights;
  for (std::size_t k = 0; k < 3; ++k) {
    asked.found[k] = static_cast<std::size_t>(
        std::ranges::count_if(found_at, [&](std::size_t at) { return at <= nights[k]; }));
  }
  return asked;
}

}  // namespace

Grid grid_of_streams(const Grid& grid, std::size_t streams) {
  Grid result = grid;
  result.methods.clear();
  for (const Method& method : grid.methods) {
    for (std::size_t k = 1; k <= streams; ++k) {
      result.methods.push_back(method);
      result.methods.back().name = fmt::format("{}.{}", method.name, k);
    }
  }
  return result;
}

std::vector<StreamSeries> streams_of(const RunFolder& run) {
  std::map<std::tuple<std::string, std::string, std::string>, StreamSeries> all;
  for (const Record& record : run.records) {
    const std::optional<std::string> method = method_of_stream(record.method);
    if (!method || !is_ok(record) || !(record.mae_test > 0) || std::isinf(record.mae_test)) {
      continue;
    }
    StreamSeries& series = all[{*method, record.operators, record.problem}];
    series.problem = record.problem;
    series.method = *method;
    series.operators = record.operators;
    series.log_errors[record.seed].push_back(elementary::log(record.mae_test));
  }
  std::vector<StreamSeries> result;
  for (auto& [key, series] : all) {
    series.spread = spread_of_streams(series);
    result.push_back(std::move(series));
  }
  if (result.empty()) {
    throw_bad_input("no method of this run has streams", run.path.string(),
                    "let 'tribench study nights' make the run");
  }
  return result;
}

NightStudy run_night_study(const RunFolder& run, const NightStudyOptions& options) {
  NightStudy study;
  study.series = streams_of(run);
  study.pairs = ask_pairs(study.series, options);
  study.sequences = ask_sequences(study.series, options);
  std::vector<std::size_t> spread;
  for (std::size_t k = 0; k < study.series.size(); ++k) {
    if (study.series[k].spread > 0) spread.push_back(k);
  }
  const auto ask = [&](const std::vector<std::size_t>& series, Detection asked) {
    study.detections.push_back(detect(study.series, series, std::move(asked), options));
  };
  for (const std::size_t before : {std::size_t{0}, options.before}) {
    for (const double loss : kLosses) {
      if (!spread.empty()) ask(spread, {"", "", loss, false, before});
    }
  }
  for (std::size_t k = 0; k < study.series.size(); ++k) {
    const StreamSeries& each = study.series[k];
    for (const double loss : kLosses) {
      ask({k}, {each.problem, each.method, loss, false, options.before});
    }
    ask({k}, {each.problem, each.method, kCreep, true, options.before});
  }
  return study;
}

}  // namespace tribench
