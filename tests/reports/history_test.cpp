// SPDX-License-Identifier: MIT
#include "reports/history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.hpp"

namespace tribench {
namespace {

std::vector<double> noise(std::uint64_t key, std::size_t n) {
  RandomStream random(key);
  std::vector<double> series(n);
  for (double& value : series) value = 0.02 * random.normal();
  return series;
}

TEST(History, FindsAStepAndWhereItIs) {
  std::vector<double> series = noise(1, 20);
  for (std::size_t i = 13; i < series.size(); ++i) series[i] += std::log(1.1);
  const Change change = find_change(series, {}, 1);
  EXPECT_EQ(change.kind, Change::Kind::step);
  EXPECT_NEAR(static_cast<double>(change.at), 13, 1);
  EXPECT_NEAR(change.ratio, 1.1, 0.03);
  EXPECT_LE(change.p, 0.001);
}

TEST(History, FindsADriftThatNoTwoNeighboursShow) {
  std::vector<double> series = noise(2, 30);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += 0.005 * static_cast<double>(i);
  const Change change = find_change(series, {}, 1);
  EXPECT_EQ(change.kind, Change::Kind::drift);
  EXPECT_NEAR(change.ratio, std::exp(0.005 * 29), 0.05);
  EXPECT_LE(change.p, 0.001);
}

TEST(History, CriesWolfNoOftenerThanItsLevel) {
  int alarms = 0;
  HistoryOptions options;
  options.permutations = 199;
  for (std::uint64_t study = 0; study < 400; ++study) {
    if (find_change(noise(100 + study, 15), options, study).p <= 0.05) ++alarms;
  }
  EXPECT_LE(alarms, 400 * 0.05 + 4 * std::sqrt(400 * 0.05 * 0.95));
}

TEST(History, HasNothingToSayAboutAShortOrConstantSeries) {
  EXPECT_EQ(find_change({1, 2, 3}, {}, 1).p, 1);
  EXPECT_EQ(find_change(std::vector<double>(10, 0.5), {}, 1).p, 1);
}

TEST(History, NamesTheMethodAndTheRun) {
  std::vector<RunFolder> runs(20);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].path = "night-" + std::to_string(i);
    for (const std::string method : {"a", "b"}) {
      Record record;
      record.method = method;
      record.problem = "p";
      record.operators = "paper";
      record.status = CellStatus::ok;
      record.mae_test = method == "b" && i >= 14 ? 1.2 : 1 + 0.001 * static_cast<double>(i % 3);
      runs[i].records.push_back(record);
    }
  }
  const std::vector<SeriesChange> changes = find_changes(runs);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].method, "b");
  EXPECT_EQ(changes[0].change.at, 14U);
  EXPECT_THAT(history_markdown(changes, runs), ::testing::HasSubstr("night-14"));
}

}  // namespace
}  // namespace tribench
