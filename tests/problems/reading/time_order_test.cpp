// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Rows every 10 ms whose y is their number.
std::vector<std::pair<double, int>> even_rows(int rows) {
  std::vector<std::pair<double, int>> list;
  for (int i = 0; i < rows; ++i) list.emplace_back(0.01 * i, i);
  return list;
}

std::string table_of(const std::vector<std::pair<double, int>>& rows) {
  std::string text = "time_s,y,remark\n";
  for (const auto& [time, y] : rows) text += fmt::format("{:.3f},{},r{}\n", time, y, y);
  return text;
}

std::string complaint_about(const std::string& text) {
  try {
    parse_csv(text, "log.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "read";
}

std::vector<double> in_order(const DataFile& file) { return file.data.at("y").values; }

TEST(TimeOrder, MessagesThatWereOvertakenAreSortedWithAllThatTheySay) {
  std::vector<std::pair<double, int>> rows = even_rows(300);
  std::swap(rows[50], rows[51]);
  std::rotate(rows.begin() + 100, rows.begin() + 101, rows.begin() + 104);  // one, three too late
  const DataFile file = parse_csv(table_of(rows), "log.csv");
  ASSERT_THAT(file.warnings, ElementsAre(HasSubstr("2 rows stand out of the order of time")));
  EXPECT_THAT(file.warnings[0], HasSubstr("line 53"));
  const std::vector<double> y = in_order(file);
  EXPECT_TRUE(std::ranges::is_sorted(y));
  for (std::size_t i = 0; i < y.size(); ++i) {
    ASSERT_EQ(file.texts[0].values[i], fmt::format("r{}", y[i]));
    ASSERT_DOUBLE_EQ(file.data.find(Role::time)->values[i], 0.01 * static_cast<double>(i));
  }
}

TEST(TimeOrder, AClockThatIsSetBackOrBeginsAnewMakesAnotherRecording) {
  for (const double back : {0.5, 1.5}) {  // a correction; from 0 again
    std::vector<std::pair<double, int>> rows = even_rows(400);
    for (std::size_t i = 150; i < rows.size(); ++i) rows[i].first -= back;
    const DataFile file = parse_csv(table_of(rows), "log.csv");
    EXPECT_THAT(file.data.movement_names, ElementsAre("log, part 1", "log, part 2"));
    EXPECT_EQ(std::ranges::count(file.data.movement, 0), 150);
    EXPECT_FALSE(file.has_movements);
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("another recording begins there")));
    EXPECT_TRUE(std::ranges::is_sorted(in_order(file)));
  }
}

TEST(TimeOrder, AClockWhoseCounterIsFullGoesOn) {
  for (const double full : {65.536, 4294.967296, 4.294967296}) {
    std::vector<std::pair<double, int>> rows = even_rows(1200);
    for (auto& [time, y] : rows) time = std::fmod(time + full - 2, full);
    const DataFile file = parse_csv(table_of(rows), "log.csv");
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("as a full counter does: the clock goes on")));
    const std::vector<double>& time = file.data.find(Role::time)->values;
    for (std::size_t i = 0; i < time.size(); ++i) {
      ASSERT_NEAR(time[i], full - 2 + 0.01 * static_cast<double>(i), 2e-3) << full;
    }
  }
}

TEST(TimeOrder, TheNewestRowMayStandFirst) {
  std::vector<std::pair<double, int>> rows = even_rows(300);
  std::ranges::reverse(rows);
  const DataFile file = parse_csv(table_of(rows), "log.csv");
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("newest row stands first")));
  EXPECT_TRUE(std::ranges::is_sorted(in_order(file)));
}

TEST(TimeOrder, WhatIsNotPlainIsRefused) {
  // Too many to be messages that were overtaken.
  std::vector<std::pair<double, int>> rows = even_rows(300);
  for (std::size_t i = 0; i + 1 < rows.size(); i += 4) std::swap(rows[i], rows[i + 1]);
  EXPECT_THAT(complaint_about(table_of(rows)), HasSubstr("log.csv:3:time_s: time runs back"));
  // A column names the movements.
  std::string named = "movement,time_s\n";
  for (int i = 0; i < 400; ++i) named += fmt::format("a,{}\n", i % 200);
  EXPECT_THAT(complaint_about(named), HasSubstr("sort the rows"));
  // So does this one, if somebody says so.
  std::string numbered = "run,time_s\n";
  for (int i = 0; i < 400; ++i) numbered += fmt::format("{},{}\n", i / 200, i % 200);
  EXPECT_THAT(complaint_about(numbered), HasSubstr("--roles run=movement"));
}

}  // namespace
}  // namespace tribench
