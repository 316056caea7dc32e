// SPDX-License-Identifier: MIT
#include "reports/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "foundation/random.hpp"

namespace tribench {
namespace {

using Rows = std::vector<std::vector<std::string>>;

CsvReading read(const std::string& text, Rows& rows) {
  std::istringstream in(text);
  const auto keep = [&](const std::vector<std::string_view>& fields) {
    rows.emplace_back(fields.begin(), fields.end());
  };
  return read_csv(in, keep, keep);
}

TEST(Csv, ReadsQuotedCommasQuotesAndLineEndsAsWritten) {
  Rows rows;
  read("a,b\r\n\"x,\"\"y\"\"\",\"two\nlines\"\n", rows);
  EXPECT_EQ(rows, (Rows{{"a", "b"}, {"x,\"y\"", "two\nlines"}}));
}

TEST(Csv, DropsATornLastLineAndSaysSo) {
  Rows rows;
  const CsvReading reading = read("a,b\n1,2\n3", rows);
  EXPECT_EQ(rows, (Rows{{"a", "b"}, {"1", "2"}}));
  ASSERT_EQ(reading.complaints.size(), 1U);
  EXPECT_EQ(reading.complaints[0], "line 3: torn off in its middle; dropped");
}

TEST(Csv, DropsARowOfAnotherWidthAndNamesItsLine) {
  Rows rows;
  const CsvReading reading = read("a,b\n1,2,3\n4,5\n", rows);
  EXPECT_EQ(rows, (Rows{{"a", "b"}, {"4", "5"}}));
  ASSERT_EQ(reading.complaints.size(), 1U);
  EXPECT_EQ(reading.complaints[0], "line 2: 3 fields where the header has 2; dropped");
}

TEST(Csv, SurvivesBeingCutAtAnyByte) {
  const std::string whole = "a,b\n\"x,\"\"y\"\"\",2\n3,\"4\n5\"\n";
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    Rows rows;
    read(whole.substr(0, cut), rows);
    EXPECT_LE(rows.size(), 3U);
  }
}

TEST(Csv, AnyTextComesBackAsItWent) {
  RandomStream random(2);
  const std::string alphabet = "a,\"\n\r ;|";
  for (int i = 0; i < 500; ++i) {
    std::vector<std::string> fields(3);
    for (std::string& field : fields) {
      for (std::uint64_t n = random.below(6); n > 0; --n) field += alphabet[random.below(8)];
    }
    std::string text = "a,b,c\n";
    append_csv_row(text, fields);
    Rows rows;
    read(text, rows);
    ASSERT_EQ(rows.size(), 2U) << text;
    EXPECT_EQ(rows[1], fields) << text;
  }
}

TEST(CsvNumber, ComesBackToTheSameDoubleAndMissingIsEmpty) {
  RandomStream random(4);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-300, 300));
    double back = 0;
    ASSERT_TRUE(read_csv_number(csv_number(value), back));
    EXPECT_EQ(back, value);
  }
  EXPECT_EQ(csv_number(std::nan("")), "");
  double back = 0;
  EXPECT_TRUE(read_csv_number("", back));
  EXPECT_TRUE(std::isnan(back));
  EXPECT_TRUE(read_csv_number(csv_number(-std::numeric_limits<double>::infinity()), back));
  EXPECT_EQ(back, -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(read_csv_number("1.5x", back));
}

}  // namespace
}  // namespace tribench
