// SPDX-License-Identifier: MIT
//
// The store of a nightly job and what it says over years, on made nights with known changes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "reports/bench_comparison.hpp"
#include "reports/night_feed.hpp"
#include "reports/night_page.hpp"
#include "reports/night_store.hpp"
#include "reports/night_tests.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Made {
  int problems = 4;
  std::uint64_t seeds = 20;
  double seed_spread = 0.3;    // of the data: the same in every night
  double night_spread = 0.05;  // what differs between two runs of code that is no better or worse
};

// Night k of a store; `loss` multiplies the errors of method "b" on problem "p0".
Night made_night(int k, double loss, std::uint64_t key, const Made& made = {}) {
  Night night;
  night.name = fmt::format("2026-{:06}", k);
  night.commit = fmt::format("c{}", k);
  night.grid = "g";
  night.data = "d";
  for (int problem = 0; problem < made.problems; ++problem) {
    for (const std::string method : {"a", "b", "c"}) {
      NightSeries series;
      series.problem = fmt::format("p{}", problem);
      series.method = method;
      series.operators = "paper";
      RandomStream noise(key_of(fmt::format("{}|{}|{}", key, k, series.key())));
      double middle = 0;
      for (std::uint64_t seed = 1; seed <= made.seeds; ++seed) {
        RandomStream own(key_of(fmt::format("{}|{}|{}", key, series.key(), seed)));
        const double planted = problem == 0 && method == "b" ? std::log(loss) : 0;
        const double value =
            made.seed_spread * own.normal() + made.night_spread * noise.normal() + planted;
        series.log_errors.emplace_back(seed, static_cast<float>(value));
        middle += value / static_cast<double>(made.seeds);
      }
      series.cells = made.seeds;
      series.median_error = std::exp(middle);
      series.cpu_s = 1;
      series.evaluations = 1e6;
      night.series.push_back(series);
    }
  }
  return night;
}

// What a loop costs, with a factor on its instructions; times differ by 3 % from night to night.
std::vector<NightBench> made_benches(int count, int night, double factor) {
  std::vector<NightBench> benches;
  for (int k = 0; k < count; ++k) {
    RandomStream noise(key_of(fmt::format("bench {} {}", k, night)));
    NightBench bench;
    bench.name = fmt::format("some_bench loop<double, {}>/rows:{}", k, 10 * k);
    bench.instructions = 1e6 * (k + 1) * (k == 1 ? factor : 1) * (1 + 5e-4 * noise.uniform());
    bench.first_level_misses = 4000 + static_cast<double>(noise.below(200));
    bench.last_level_misses = 900;
    bench.time = 0.1 * (k + 1) * std::exp(0.03 * noise.normal());
    bench.time_spread = 0.02;
    benches.push_back(bench);
  }
  return benches;
}

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Night, ReadsBackAsItWasPrintedAndIsRefusedWhereDamaged) {
  const Night night = made_night(1, 1, 7);
  const std::string text = print_night(night);
  EXPECT_EQ(print_night(read_night(text, "here")), text);
  EXPECT_TRUE(read_night(text, "here", false).series.at(0).log_errors.empty());
  Night with_spread = night;
  with_spread.series.at(1).spread = 0.125;  // of nights before it was kept there is none
  for (const bool with_seeds : {false, true}) {
    const Night read = read_night(print_night(with_spread), "here", with_seeds);
    EXPECT_TRUE(std::isnan(read.series.at(0).spread));
    EXPECT_EQ(read.series.at(1).spread, 0.125);
  }
  Night with_benches = night;
  with_benches.benches = made_benches(3, 1, 1);
  with_benches.bench_conditions = "valgrind-3.19.0, avx2";
  const Night read = read_night(print_night(with_benches), "here");
  EXPECT_EQ(print_night(read), print_night(with_benches));
  EXPECT_EQ(read.series.size(), night.series.size());
  EXPECT_EQ(read.benches.at(2).name, "some_bench loop<double, 2>/rows:20");
  for (std::size_t at = 0; at < text.size(); at += 37) {
    std::string damaged = text;
    damaged[at] = damaged[at] == 'x' ? 'y' : 'x';
    EXPECT_THAT(refusal([&] { read_night(damaged, "here"); }), HasSubstr("damaged")) << at;
  }
  EXPECT_THAT(refusal([&] { read_night(text.substr(0, text.size() / 2), "here"); }),
              HasSubstr("damaged"));
}

TEST(Benches, OfEqualCodeAreNeverDearerAndOnePerCentIs) {
  Night base;
  base.benches = made_benches(40, 0, 1);
  Night now;
  for (int night = 1; night <= 200; ++night) {
    now.benches = made_benches(40, night, 1);
    const BenchComparison same = compare_benches(base, now);
    EXPECT_THAT(same.worse, IsEmpty()) << night;
    EXPECT_THAT(same.slower, IsEmpty()) << night;
    now.benches = made_benches(40, night, 1.01);
    const BenchComparison dearer = compare_benches(base, now);
    ASSERT_EQ(dearer.worse.size(), 1U) << night;
    EXPECT_EQ(dearer.worse.front().name, base.benches[1].name);
  }
  EXPECT_THAT(compare_benches(base, now).sentence(), HasSubstr("1.0 % more instructions"));
}

TEST(Benches, SayWhatCannotBeComparedAndWhatIsGone) {
  Night base;
  base.benches = made_benches(3, 0, 1);
  base.bench_conditions = "valgrind-3.19.0, avx2";
  Night now = base;
  now.benches.pop_back();
  EXPECT_EQ(compare_benches(base, now).gone.size(), 1U);
  now = base;
  now.benches[0].first_level_misses += 20'000;
  now.benches[2].time *= 2;
  const BenchComparison cache = compare_benches(base, now);
  ASSERT_EQ(cache.worse.size(), 1U);
  EXPECT_EQ(cache.worse.front().figure, BenchChange::Figure::first_level_misses);
  EXPECT_EQ(cache.slower.size(), 1U);
  EXPECT_THAT(cache.sentence(), HasSubstr("by the clock alone"));
  Night elsewhere = now;
  elsewhere.machine = "another processor";
  EXPECT_THAT(compare_benches(base, elsewhere).worse, IsEmpty());
  EXPECT_THAT(compare_benches(base, elsewhere).sentence(), HasSubstr("the CPUs differ"));
  now.bench_conditions = "valgrind-3.22.0, avx2";
  EXPECT_THAT(compare_benches(base, now).worse, IsEmpty());
  EXPECT_THAT(compare_benches(base, now).sentence(), HasSubstr("valgrind-3.22.0"));
  EXPECT_THAT(compare_benches({}, now).sentence(), HasSubstr("the base has none"));
  EXPECT_EQ(compare_benches(base, {}).sentence(), "");
}

TEST(NightStore, KeepsNightsAsTheyAreAndNeverReplacesABase) {
  const testing::TemporaryFolder folder;
  NightStore store(folder / "store");
  EXPECT_FALSE(store.base());
  store.record(made_night(1, 1, 7));
  store.record(made_night(1, 1, 7));  // the same again is no change
  EXPECT_THAT(refusal([&] { store.record(made_night(1, 2, 7)); }), HasSubstr("never changed"));
  EXPECT_THAT(refusal([&] { store.base(); }), HasSubstr("nights and no base"));
  EXPECT_THAT(refusal([&] { store.bless({"2026-000001", "", "t"}); }), HasSubstr("a reason"));
  EXPECT_THAT(refusal([&] { store.bless({"2026-000009", "why", "t"}); }), HasSubstr("missing"));
  store.bless({"2026-000001", "first", "2026-01-01T00:00:00Z"});
  for (int k = 2; k <= 9; ++k) store.record(made_night(k, 1, 7));
  EXPECT_EQ(store.base()->name, "2026-000001");
  store.bless({"2026-000003", "faster", "2026-01-02T00:00:00Z"});
  EXPECT_EQ(store.base()->name, "2026-000003");
  EXPECT_THAT(refusal([&] {
                store.bless({"2026-000005", "late", "2026-01-01T12:00:00Z"});
              }),
              HasSubstr("set the clock"));
  EXPECT_EQ(store.prune(4, false).size(), 3U);  // 2, 4, 5: blessed ones stay
  EXPECT_EQ(store.names().size(), 9U);
  EXPECT_EQ(store.prune(4, true).size(), 3U);
  EXPECT_EQ(store.names().size(), 6U);
  std::filesystem::remove(folder / "store" / "nights" / "2026-000003.night");
  EXPECT_THAT(refusal([&] { store.base(); }), HasSubstr("missing"));
  testing::write_text(folder / "store" / "nights" / "2026-000003.night", "torn");
  EXPECT_THAT(refusal([&] { store.base(); }), HasSubstr("damaged"));
}

TEST(NightTests, ACreepOfOnePerCentANightIsFoundWithinAWeek) {
  const Night base = made_night(0, 1, 5, {4, 20, 0.3, 0.02});
  std::vector<Night> since;
  for (int k = 1; k <= 7; ++k) {
    since.push_back(made_night(k, std::pow(1.01, k), 5, {4, 20, 0.3, 0.02}));
  }
  const auto findings = find_losses(base, since);
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings.front().method, "b");
}

// At most one false alarm in a year: 200 years of nights that are all alike.
TEST(NightTests, HoldsItsRateOfFalseAlarms) {
  int alarms = 0;
  constexpr int kSequences = 300;
  constexpr int kNights = 8;
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    const auto key = static_cast<std::uint64_t>(1000 + sequence);
    const Night base = made_night(0, 1, key);
    std::vector<Night> since;
    for (int k = 1; k <= kNights; ++k) since.push_back(made_night(k, 1, key));
    if (!find_losses(base, since).empty()) ++alarms;
  }
  // 300 nights are asked: 0.82 alarms are what is allowed.
  EXPECT_LE(alarms, 3);
}

// What one, three and seven nights find of a loss in one method on one problem, and how soon a
// creep of 1 % a night is found. Two runs of equally good code differ by 5 % a seed here.
TEST(NightTests, FindMoreTheMoreNightsTheyHave) {
  constexpr int kTrials = 60;
  const auto detected = [](double loss, int nights) {
    int found = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto key = static_cast<std::uint64_t>(5000 + trial);
      std::vector<Night> since;
      for (int k = 1; k <= nights; ++k) since.push_back(made_night(k, 1 + loss, key));
      found += find_losses(made_night(0, 1, key), since).empty() ? 0 : 1;
    }
    return found;
  };
  std::printf("loss   1 night  3 nights  7 nights (of %d)\n", kTrials);
  for (const double loss : {0.01, 0.03, 0.05, 0.10}) {
    const int one = detected(loss, 1);
    const int three = detected(loss, 3);
    const int seven = detected(loss, 7);
    std::printf("%4.0f %% %7d %9d %9d\n", 100 * loss, one, three, seven);
    EXPECT_LE(one, three + 2);
    EXPECT_LE(three, seven + 2);
    if (loss < 0.10) continue;
    EXPECT_GT(three, one) << "three nights decide what one cannot";
    EXPECT_GE(three, kTrials - 5);
  }
  int within_five = 0;
  int within_seven = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto key = static_cast<std::uint64_t>(9000 + trial);
    const Night base = made_night(0, 1, key, {4, 20, 0.3, 0.02});
    std::vector<Night> since;
    int found_at = 99;
    for (int k = 1; k <= 7 && found_at == 99; ++k) {
      since.push_back(made_night(k, std::pow(1.01, k), key, {4, 20, 0.3, 0.02}));
      if (!find_losses(base, since).empty()) found_at = k;
    }
    within_five += found_at <= 5 ? 1 : 0;
    within_seven += found_at <= 7 ? 1 : 0;
  }
  std::printf("creep of 1 %% a night at 2 %% noise: found within 5 nights in %d, 7 in %d of %d\n",
              within_five, within_seven, kTrials);
  EXPECT_GE(within_seven, kTrials - 3);
}

// A search that draws anew each night makes its noise known: what the base alone could not decide,
// a night with others before it does.
TEST(NightTests, KnowTheNoiseFromTheNightsBefore) {
  constexpr int kTrials = 20;
  const Made quiet{4, 20, 0.3, 0.02};
  const auto found = [&](int before) {
    int hits = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto key = static_cast<std::uint64_t>(7000 + trial);
      std::vector<Night> since;
      for (int k = 1; k <= before; ++k) since.push_back(made_night(k, 1, key, quiet));
      since.push_back(made_night(before + 1, 1.03, key, quiet));
      hits += find_losses(made_night(0, 1, key, quiet), since).empty() ? 0 : 1;
    }
    return hits;
  };
  const int alone = found(0);
  const int known = found(15);
  std::printf("3 %% at 2 %% noise, one night: %d of %d after the base, %d after 15 nights\n", alone,
              kTrials, known);
  EXPECT_GE(known, kTrials - 4);
  EXPECT_GT(known, alone);
}

// Nights of code that does not touch a method repeat its figures: no witnesses of their own.
TEST(NightTests, ARepeatedFigureIsNoSecondWitness) {
  const Night base = made_night(0, 1, 11);
  const Night worse = made_night(1, 1.04, 11);
  std::vector<Night> since = {worse};
  const bool once = !find_losses(base, since).empty();
  for (int k = 2; k <= 7; ++k) {
    since.push_back(worse);
    since.back().name = fmt::format("2026-{:06}", k);
  }
  EXPECT_FALSE(once);
  EXPECT_THAT(find_losses(base, since), IsEmpty());
}

TEST(NightTests, ALuckyBaseLeavesNothingUndecidedForEver) {
  const Made made{2, 20, 0.3, 0.10};
  Night lucky = made_night(0, 1, 21, made);
  for (NightSeries& series : lucky.series) {
    for (auto& [seed, value] : series.log_errors) value -= 0.12F;
  }
  std::vector<Night> since;
  for (int k = 1; k <= 8; ++k) since.push_back(made_night(k, 1, 21, made));
  Comparison comparison;
  ComparisonRow row;
  row.method = "c";
  row.operators = "paper";
  row.problem = "p1";
  row.undecided = true;
  comparison.quality = {row};
  settle_by_nights(comparison, lucky, std::span(since).first(2));
  EXPECT_TRUE(comparison.quality.front().undecided) << "too few nights to say";
  settle_by_nights(comparison, lucky, since);
  EXPECT_FALSE(comparison.quality.front().undecided);
  for (NightSeries& series : since.back().series) {
    for (auto& [seed, value] : series.log_errors) value += 0.2F;
  }
  comparison.quality.front().undecided = true;
  settle_by_nights(comparison, lucky, since);
  EXPECT_TRUE(comparison.quality.front().undecided) << "worse than all nights before it";
}

TEST(NightTests, LeavesNightsOfAnotherGridOut) {
  const Night base = made_night(0, 1, 9);
  std::vector<Night> since = {made_night(1, 3, 9)};
  EXPECT_FALSE(find_losses(base, since).empty());
  since.back().grid = "other";
  EXPECT_THAT(find_losses(base, since), IsEmpty());
}

struct NightsRead {
  StoreHistory history;
  std::string page;
  double seconds = 0;  // CPU, of up to three rounds the least: the machine may be busy
};

// So many nights, of these texts in turn: the first ones up to night 2000. Read again while it
// takes longer than `bound_s`.
NightsRead nights_read(const std::filesystem::path& folder, int count,
                       const std::vector<std::string>& before,
                       const std::vector<std::string>& after, double bound_s) {
  NightStore store(folder);
  for (int k = 0; k < count; ++k) {
    const std::vector<std::string>& texts = k < 2000 ? before : after;
    std::ofstream(folder / "nights" / fmt::format("2026-{:06}.night", k))
        << texts[static_cast<std::size_t>(k) % texts.size()];
  }
  store.bless({"2026-000000", "<b>first</b>", "2026-01-01T00:00:00Z"});
  NightsRead read;
  read.seconds = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3 && read.seconds >= bound_s; ++round) {
    const std::clock_t start = std::clock();
    read.history = read_history(store);
    read.page = history_page(read.history);
    read.seconds = std::min(read.seconds, static_cast<double>(std::clock() - start) /
                                              static_cast<double>(CLOCKS_PER_SEC));
  }
  return read;
}

// Ten years of nights of 2 000 cells: within seconds and megabytes.
TEST(NightPage, HoldsTenYears) {
  const testing::TemporaryFolder folder;
  Made made;
  made.problems = 33;  // times 3 methods times 20 seeds
  // Forty nights of either level, again and again: only how many they are matters.
  constexpr int kDifferent = 40;
  const auto made_text = [&](int k, bool is_late) {
    Night night = made_night(k, is_late ? 1.3 : 1, 2, made);
    night.started = is_late ? "2027-01-01T02:30:00Z" : "2026-01-01T02:30:00Z";
    night.benches = made_benches(150, k, is_late ? 1.01 : 1);
    return print_night(night);
  };
  std::vector<std::string> before;
  std::vector<std::string> after;
  for (int k = 0; k < kDifferent; ++k) before.push_back(made_text(k, false));
  for (int k = 0; k < kDifferent; ++k) after.push_back(made_text(k, true));
  constexpr double kBound_s = 2;
  const double year_s = nights_read(folder / "year", 365, before, after, kBound_s).seconds;
  const auto [history, page, seconds] =
      nights_read(folder / "store", 3650, before, after, kBound_s);
#ifndef TRIBENCH_SANITIZED
  EXPECT_LT(seconds, kBound_s);
  EXPECT_LT(seconds, 10 * year_s);
#endif
  std::printf("%zu bytes, %.2f s, a year %.2f s\n", page.size(), seconds, year_s);
  EXPECT_EQ(history.nights.size(), 3650U);
  EXPECT_EQ(history.benches.size(), 150U);
  EXPECT_LT(page.size(), 5U << 20);
  EXPECT_TRUE(page.find("&lt;b&gt;first") != std::string::npos);
  const std::vector<HistoryChange> changes = changes_of(history);
  EXPECT_LE(changes.size(), 8U);  // 249 lines of ten years: two or three by chance
  const auto ratio_of = [&](const std::string& problem, const std::string& method) {
    for (const HistoryChange& each : changes) {
      if (each.problem == problem && each.method == method && each.night == 2000) return each.ratio;
    }
    return 0.0;
  };
  EXPECT_NEAR(ratio_of("p0", "b"), 1.3, 0.01);
  EXPECT_NEAR(ratio_of("some_bench loop<double, 1>/rows:10", ""), 1.01, 2e-4);
  const std::string feed = history_feed(history);
  EXPECT_THAT(feed, HasSubstr("loop&lt;double, 1&gt;/rows:10: +1.0 % instructions"));
  EXPECT_THAT(feed, HasSubstr("<updated>2027-01-01T02:30:00Z</updated>"));
}

// Every third night is loud: its seeds lie 25 times as far apart, and its median is as unsure. What
// the quiet nights show is seen where the nights tell their spread, and is not where they do not.
TEST(NightHistory, BelievesANightTheLessTheFurtherItsSeedsLieApart) {
  const auto first_of_new_level = [](bool tells_spread) {
    const testing::TemporaryFolder folder;
    NightStore store(folder / "store");
    for (int k = 0; k < 120; ++k) {
      const double spread = k % 3 == 1 ? 7.5 : 0.3;
      Night night = made_night(k, k < 60 ? 1 : 1.05, 11, {1, 5, 0.3, spread / 15});
      for (NightSeries& series : night.series) series.spread = tells_spread ? spread : kMissing;
      std::ofstream(folder / "store" / "nights" / (night.name + ".night")) << print_night(night);
    }
    std::vector<std::size_t> nights;
    for (const HistoryChange& each : changes_of(read_history(store))) nights.push_back(each.night);
    return nights;
  };
  EXPECT_THAT(first_of_new_level(true), ::testing::ElementsAre(60));
  EXPECT_THAT(first_of_new_level(false), ::testing::Not(::testing::Contains(60)));
}

TEST(NightHistory, SaysHowFarCountsOfEqualCodeDiffer) {
  const testing::TemporaryFolder folder;
  NightStore store(folder / "store");
  for (int k = 0; k < 4; ++k) {
    Night night = made_night(k, 1, 2, {1, 5});
    night.commit = k < 3 ? "one" : "another";
    night.machine = k % 2 == 0 ? "here" : "there";
    night.benches = made_benches(2, 0, 1);
    if (k == 2) night.benches[1].instructions *= 1.0004;
    if (k == 3) night.benches[0].instructions *= 1.5;  // other code: no spread
    store.record(night);
  }
  const CountSpread counts = spread_of_counts(read_history(store));
  EXPECT_EQ(counts.cases, 2U);
  EXPECT_EQ(counts.nights, 3U);
  EXPECT_EQ(counts.name, "some_bench loop<double, 1>/rows:10");
  EXPECT_NEAR(counts.spread, 0.0004, 1e-5);
  EXPECT_THAT(history_text(read_history(store)),
              HasSubstr("(3 at most) differ by 0.0400 % at most"));
}

// What a reader of feeds takes: well-formed XML whose entries keep their names.
TEST(NightFeed, IsWellFormedAndItsEntriesKeepTheirNames) {
  const testing::TemporaryFolder folder;
  NightStore store(folder / "store");
  for (int k = 0; k < 30; ++k) {
    Night night = made_night(k, k < 15 ? 1 : 1.5, 2, {2, 20, 0.3, 0.02});
    night.started = fmt::format("2026-01-{:02}T02:30:00Z", k + 1);
    night.machine = "a <fast> & \"quiet\" one";
    store.record(night);
  }
  store.bless({"2026-000000", "]]> & <b>", "2026-01-01T03:00:00Z"});
  const std::string feed = history_feed(read_history(store));
  EXPECT_THAT(feed, HasSubstr("b (paper) on p0: +5"));
  EXPECT_THAT(feed, HasSubstr("<updated>2026-01-16T02:30:00Z</updated>"));
  const auto names_of = [](const std::string& text) {
    std::vector<std::string> names;
    for (std::size_t at = 0; (at = text.find("<id>", at)) != std::string::npos; ++at) {
      names.push_back(text.substr(at, text.find("</id>", at) - at));
    }
    return names;
  };
  store.record(made_night(30, 1.5, 2, {2, 20, 0.3, 0.02}));
  EXPECT_EQ(names_of(history_feed(read_history(store))), names_of(feed));
  testing::write_text(folder / "feed.xml", feed);
  const testing::ProgramRun parsed = testing::run_to_end(
      {"python3", "-c", "import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])",
       (folder / "feed.xml").string()});
  EXPECT_EQ(parsed.status, 0) << parsed.errors;
}

}  // namespace
}  // namespace tribench
